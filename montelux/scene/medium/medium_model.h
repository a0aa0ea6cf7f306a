// MediumModel: the concept of a participating medium, and the values that its functions exchange.
#pragma once

#include <array>
#include <concepts>
#include <type_traits>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/medium/majorant_walk.h"
#include "montelux/scene/medium/phase_function.h"
#include "montelux/scene/scene_spectrum.h"

namespace montelux {

struct Scene;
struct SceneView;

// Coefficients at a point, per unit of length in world space.
struct MediumPoint {
    SampledSpectrum sigma_a, sigma_s;
    SampledSpectrum emission; // radiance per unit of length: sigma_a times the emitted radiance Le
};

// An affine map in single precision.
struct AffineMap {
    std::array<Vec3f, 3> rows{Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}};
    Vec3f offset{};

    AffineMap() = default;
    explicit AffineMap(const Transform& t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& row = t.matrix().m[i];
            rows[i] = Vec3f(Vec3d(row[0], row[1], row[2]));
            offset[static_cast<int>(i)] = static_cast<float>(row[3]);
        }
    }
    Vec3f vector(Vec3f v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
    Point3f point(Point3f p) const { return vector(p) + offset; }
    // With the same t.
    Ray ray(const Ray& r) const { return {point(r.o), vector(r.d), r.t_max}; }
};

// The box that a medium fills, in its own space; outside there is nothing.
struct MediumBox {
    Point3f p0{0, 0, 0}, p1{1, 1, 1}; // p0 < p1
    Transform world_from_medium;      // affine

    AffineMap medium_from_world() const { return AffineMap(world_from_medium.inverse()); }
    // The point of the box at a point of the unit cube.
    Point3f at(Point3f unit) const {
        return {p0.x + unit.x * (p1.x - p0.x), p0.y + unit.y * (p1.y - p0.y), p0.z + unit.z * (p1.z - p0.z)};
    }
    // The box becomes the unit cube.
    AffineMap unit_from_world() const;
};

// Computed once for a medium. Empty for a homogeneous one.
struct MediumTable {
    AffineMap unit_from_world, medium_from_world;
    MajorantGrid majorants;
};

// A medium at the wavelengths of a path. The scene must outlive it.
template <typename S>
concept SampledMedium = requires(const S& s, Point3f p, const Ray& ray) {
    // Within the segments of `majorants` only.
    { s.coefficients(p) } -> std::same_as<MediumPoint>;
    // Bounds of sigma_a + sigma_s along a ray with a direction of unit length, up to its t_max.
    { s.majorants(ray) } -> std::same_as<MajorantWalk>;
};

// Plain values that refer to grids and spectra of the scene by index.
template <typename M>
concept MediumModel = std::is_trivially_copyable_v<M> &&
    requires(const M& m, const Scene& scene, const SceneView& view, Index medium,
             const SampledWavelengths& lambda) {
    { M::name } -> std::convertible_to<const char*>; // for messages
    // The same everywhere: free paths and transmittance have closed forms.
    { M::homogeneous } -> std::convertible_to<bool>;
    { m.phase } -> std::same_as<const PhaseFunction&>;
    // `medium` is its own index, by which it finds its table.
    { m.at(view, medium, lambda) } -> SampledMedium;
    { m.table(scene) } -> std::same_as<MediumTable>;
};

} // namespace montelux
