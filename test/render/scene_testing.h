// Small scenes with known answers, and their pictures.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/render/renderer.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::testing {

inline constexpr SamplerKind samplers[] = {SamplerKind::independent, SamplerKind::stratified,
                                           SamplerKind::halton,      SamplerKind::hammersley,
                                           SamplerKind::sobol,       SamplerKind::sobol_blue_noise};

// The spectrum of an RGB light with film RGB (1, 1, 1), added to the scene, and its scale.
inline Spectrum white_spectrum() { return Spectrum(RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1})); }
inline SceneSpectrum white_light(Scene& scene) { return add_spectrum(scene, white_spectrum()); }
inline float white_scale() { return photometric_scale(white_spectrum()); }

inline SpectrumParameter gray(float value) { return {value}; }

// A square of side 2 around the origin of the plane z = 0 of `t`, normal +z.
inline TriangleMesh square(const Transform& t) {
    TriangleMesh m;
    for (Vec3d p : {Vec3d{-1, -1, 0}, Vec3d{1, -1, 0}, Vec3d{1, 1, 0}, Vec3d{-1, 1, 0}})
        m.positions.push_back(Vec3f(t.point(p)));
    m.indices = {0, 1, 2, 0, 2, 3};
    return m;
}

class SceneBuilder {
  public:
    SceneBuilder() {
        description.film.width = description.film.height = 8;
        description.film.crop = {0, 0, 8, 8};
        description.film.filter = BoxFilter{};
        description.sampler.kind = SamplerKind::independent;
        description.sampler.spp = 64;
        description.integrator.max_depth = 5;
    }
    // In a copy, `scene` refers to the copy.
    SceneBuilder(const SceneBuilder& other) : description(other.description) {}
    SceneBuilder& operator=(const SceneBuilder&) = delete;

    SceneDescription description;
    Scene& scene = description.scene;

    Index add(const Material& m) {
        scene.materials.push_back(m);
        return static_cast<Index>(scene.materials.size() - 1);
    }
    Index add_mesh(TriangleMesh mesh, Index material, float emission = 0) {
        return add_shape(std::move(mesh), material, emission, false);
    }
    Index add_quadric(const Quadric& quadric, Index material, float emission = 0, bool flip = false) {
        return add_shape(quadric, material, emission, flip);
    }
    void add_uniform_light(float radiance) {
        scene.lights.push_back(UniformInfiniteLight{white_light(scene), white_scale() * radiance});
    }
    void look(Vec3d from, Vec3d to, float fov) {
        Vec3d up = std::abs(normalize(to - from).z) > 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
        scene.camera.world_from_camera = Transform::look_at(from, to, up)->inverse();
        scene.camera.model = PerspectiveCamera{.fov = fov};
    }

  private:
    Index add_shape(Geometry geometry, Index material, float emission, bool flip) {
        const Emission light{white_light(scene), emission * white_scale()};
        CallMessages messages("scene of a test");
        return montelux::SceneBuilder(scene, messages)
            .add_shape(std::move(geometry), {material, {1}, flip, emission > 0 ? &light : nullptr});
    }
};

// Mean of one channel over all pixels with its standard error: pixels are independent.
struct PictureMean {
    double mean = 0, standard_error = 0;
};
inline PictureMean picture_mean(const Film& film, int channel = 1) {
    double sum = 0, variance = 0;
    const PixelBounds& b = film.bounds();
    for (int y = b.y0; y < b.y1; ++y)
        for (int x = b.x0; x < b.x1; ++x) {
            sum += film.pixel(x, y).replicates().mean(channel);
            variance += film.pixel(x, y).replicates().variance_of_mean(channel);
        }
    double n = double(b.width()) * b.height();
    return {sum / n, std::sqrt(variance) / n};
}

// Bit-identical.
inline bool same_pixel(const Pixel& a, const Pixel& b) {
    auto same = [](Vec3f v, Vec3f w) { return v.x == w.x && v.y == w.y && v.z == w.z; };
    for (int c = 0; c < 3; ++c)
        if (a.replicates().mean(c) != b.replicates().mean(c) ||
            a.replicates().variance(c) != b.replicates().variance(c) ||
            a.replicates().skewness(c) != b.replicates().skewness(c))
            return false;
    return a.replicates().count() == b.replicates().count() && a.samples() == b.samples() &&
           a.bad() == b.bad() && same(a.albedo(), b.albedo()) && same(a.normal(), b.normal()) &&
           a.depth() == b.depth();
}

// Serves all renders of this scene, which must outlive it: film, samples and the place of the camera may differ.
inline std::shared_ptr<const PreparedScene> prepared_scene(const SceneDescription& description) {
    return std::make_shared<const PreparedScene>(description);
}

inline Film render(const SceneDescription& description,
                   std::shared_ptr<const PreparedScene> prepared = nullptr) {
    Film film(description.film);
    Renderer(description, {}, 0, std::move(prepared)).render(film);
    return film;
}

} // namespace montelux::testing
