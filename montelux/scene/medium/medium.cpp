#include "montelux/scene/medium/medium.h"

#include <limits>

#include "montelux/mc/math/fractal_noise.h"
#include "montelux/mc/math/gradient_noise.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/view.h"

namespace montelux {

namespace {

// As in pbrt-v4.
constexpr int majorant_resolution = 16, sparse_majorant_resolution = 64;

const ScalarGrid* grid(std::span<const ScalarGrid> grids, Index index) {
    return index == no_index ? nullptr : &grids[index];
}
const SparseGrid* grid(std::span<const SparseGrid> grids, Index index) {
    return index == no_index ? nullptr : &grids[index];
}
const ColorGrid* grid(std::span<const ColorGrid> grids, Index index) {
    return index == no_index ? nullptr : &grids[index];
}

// bound(lower, upper) of the density in each of n^3 cells of the unit cube.
template <typename Bound>
MajorantGrid majorant_grid(const Bound& bound, int n = majorant_resolution) {
    const auto count = static_cast<std::size_t>(n);
    MajorantGrid result{n, std::vector<float>(count * count * count)};
    parallel_for(n, [&](std::int64_t z) {
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const Point3f cell(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
                const float width = 1.0f / static_cast<float>(n);
                result.values[(static_cast<std::size_t>(z) * count + static_cast<std::size_t>(y)) * count +
                              static_cast<std::size_t>(x)] =
                    bound(cell * width, (cell + Vec3f(1, 1, 1)) * width);
            }
    });
    return result;
}

} // namespace

AffineMap MediumBox::unit_from_world() const {
    const Vec3d lower(p0), extent = Vec3d(p1) - lower;
    return AffineMap(Transform::scale({1 / extent.x, 1 / extent.y, 1 / extent.z}) *
                     Transform::translate(-lower) * world_from_medium.inverse());
}

HomogeneousMedium::Sampled HomogeneousMedium::at(const SceneView& scene, Index,
                                                 const SampledWavelengths& lambda) const {
    Sampled s;
    s.point.sigma_a = scene.sample(sigma_a, lambda) * scale;
    s.point.sigma_s = scene.sample(sigma_s, lambda) * scale;
    s.point.emission = s.point.sigma_a * scene.sample(le, lambda) * le_scale;
    return s;
}

GridMedium::Sampled GridMedium::at(const SceneView& scene, Index medium,
                                   const SampledWavelengths& lambda) const {
    return {this,
            &scene.medium_tables[medium],
            grid(scene.scalar_grids, density),
            grid(scene.scalar_grids, le_grid),
            grid(scene.scalar_grids, temperature),
            lambda,
            scene.sample(sigma_a, lambda) * scale,
            scene.sample(sigma_s, lambda) * scale,
            scene.sample(le, lambda) * le_scale};
}

MediumTable GridMedium::table(const Scene& scene) const {
    const ScalarGrid& values = scene.scalar_grids[density];
    return {box.unit_from_world(), box.medium_from_world(), majorant_grid([&](Point3f lower, Point3f upper) {
                return values.largest(lower, upper, [](float v) { return v; });
            })};
}

RgbGridMedium::Sampled RgbGridMedium::at(const SceneView& scene, Index medium,
                                         const SampledWavelengths& lambda) const {
    return {this,
            &scene.medium_tables[medium],
            grid(scene.color_grids, sigma_a),
            grid(scene.color_grids, sigma_s),
            grid(scene.color_grids, le),
            lambda,
            scene.sample(illuminant, lambda) * le_scale};
}

MediumTable RgbGridMedium::table(const Scene& scene) const {
    const auto largest = [&](Index index, Point3f lower, Point3f upper) {
        if (index == no_index) return 1.0f;
        return scene.color_grids[index].largest(lower, upper,
                                                [](const ScaledPolynomial& s) { return s.max_value(); });
    };
    return {box.unit_from_world(), box.medium_from_world(), majorant_grid([&](Point3f lower, Point3f upper) {
                return scale * (largest(sigma_a, lower, upper) + largest(sigma_s, lower, upper));
            })};
}

SparseGridMedium::Sampled SparseGridMedium::at(const SceneView& scene, Index medium,
                                               const SampledWavelengths& lambda) const {
    return {this,
            &scene.medium_tables[medium],
            grid(scene.sparse_grids, density),
            grid(scene.sparse_grids, temperature),
            AffineMap(temperature_space_from_density),
            lambda,
            scene.sample(sigma_a, lambda) * scale,
            scene.sample(sigma_s, lambda) * scale};
}

MediumTable SparseGridMedium::table(const Scene& scene) const {
    const SparseGrid& values = scene.sparse_grids[density];
    const auto bound = [&](Point3f lower, Point3f upper) {
        return values.largest(box.at(lower), box.at(upper));
    };
    return {box.unit_from_world(), box.medium_from_world(), majorant_grid(bound, sparse_majorant_resolution)};
}

FieldMedium::Sampled FieldMedium::at(const SceneView& scene, Index medium,
                                     const SampledWavelengths& lambda) const {
    const auto sampled = [&](const MediumField& f) {
        return SampledField{&f, grid(scene.scalar_grids, f.scalars), grid(scene.color_grids, f.colors),
                            scene.sample(f.value, lambda)};
    };
    return {this, &scene.medium_tables[medium], sampled(extinction), sampled(albedo), lambda};
}

MediumTable FieldMedium::table(const Scene& scene) const {
    if (!bounded) return {};
    const AffineMap unit_from_world = box.unit_from_world(), medium_from_world = box.medium_from_world();
    if (!extinction.is_grid()) return {unit_from_world, medium_from_world, {1, {1}}};
    const auto bound = [&](Point3f lower, Point3f upper) {
        // The cell in the space of the grid.
        constexpr float far = std::numeric_limits<float>::infinity();
        Point3f first(far, far, far), last(-far, -far, -far);
        for (int corner = 0; corner < 8; ++corner) {
            const Point3f unit((corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
                               (corner & 4) != 0 ? upper.z : lower.z);
            const Point3f p = extinction.unit_from_world.point(box.world_from_medium.point(box.at(unit)));
            first = min(first, p);
            last = max(last, p);
        }
        if (extinction.scalars != no_index)
            return scene.scalar_grids[extinction.scalars].largest(
                first, last, [](float v) { return v; }, extinction.wrap);
        return scene.color_grids[extinction.colors].largest(
            first, last, [](const ScaledPolynomial& s) { return s.max_value(); }, extinction.wrap);
    };
    return {unit_from_world, medium_from_world, majorant_grid(bound)};
}

float CloudMedium::density_at(Point3f p) const {
    Point3f at = p * frequency;
    if (wispiness > 0) {
        float amplitude = 0.05f * wispiness, octave = 10;
        for (int i = 0; i < 2; ++i) {
            at += gradient_noise_slope(at * octave) * amplitude;
            amplitude *= 0.5f;
            octave *= lacunarity;
        }
    }
    const float noise = 0.5f * fractal_noise(at, {.octaves = 5, .roughness = 0.5f});
    const float tops = std::clamp((1 - p.y) * 4.5f * density * noise, 0.0f, 1.0f);
    return std::clamp(tops + 2 * std::max(0.0f, 0.5f - p.y), 0.0f, 1.0f);
}

CloudMedium::Sampled CloudMedium::at(const SceneView& scene, Index medium,
                                     const SampledWavelengths& lambda) const {
    return {this, &scene.medium_tables[medium], scene.sample(sigma_a, lambda), scene.sample(sigma_s, lambda)};
}

MediumTable CloudMedium::table(const Scene&) const {
    return {box.unit_from_world(), box.medium_from_world(), {}};
}

} // namespace montelux
