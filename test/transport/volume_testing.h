// Radiance along single camera rays through media, with standard errors at each wavelength.
#pragma once

#include "test/render/scene_testing.h"
#include <array>
#include <gtest/gtest.h>
#include <string>

#include "montelux/accel/accelerator.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/transport/path_shading.h"
#include "montelux/transport/volume_path.h"

namespace montelux::testing {

inline Spectrum line(float at_360, float at_830) {
    return Spectrum(PiecewiseLinear::from_pairs(std::array{360.0f, at_360, 830.0f, at_830}));
}

// A scene of media, built by hand.
struct VolumeScene : SceneBuilder {
    VolumeScene() { description.integrator.max_depth = 1000; }

    SceneSpectrum spectrum(float at_360, float at_830) { return add_spectrum(scene, line(at_360, at_830)); }
    Index add_medium(const Medium& m) {
        scene.media.push_back(m);
        return static_cast<Index>(scene.media.size() - 1);
    }
    Index interface() { return add(InterfaceMaterial{}); }
    void bound(Index shape, Index inside, Index outside = no_index) {
        scene.shapes[shape].media = {inside, outside};
    }
    // A wide slab between z = 0 and z = `thickness`.
    void add_slab(Index medium, double thickness, double width = 1e4) {
        const Transform wide = Transform::scale({width, width, 1});
        bound(add_mesh(square(wide), interface()), no_index, medium);
        bound(add_mesh(square(Transform::translate({0, 0, thickness}) * wide), interface()), medium);
    }
    // The cube [-1, 1]^3.
    void add_cube(Index medium) {
        const Transform turns[] = {Transform(),
                                   Transform::rotate(90, {1, 0, 0}),
                                   Transform::rotate(180, {1, 0, 0}),
                                   Transform::rotate(270, {1, 0, 0}),
                                   Transform::rotate(90, {0, 1, 0}),
                                   Transform::rotate(-90, {0, 1, 0})};
        const Index material = interface();
        for (const Transform& turn : turns)
            bound(add_mesh(square(turn * Transform::translate({0, 0, 1})), material), medium);
    }
    // The same radiance at all wavelengths.
    void add_sky(float radiance = 1) {
        scene.lights.push_back(UniformInfiniteLight{SceneSpectrum(radiance), 1});
    }
    Index add_grid(int nx, int ny, int nz, std::vector<float> values) {
        ScalarGrid& grid = scene.scalar_grids.emplace_back();
        grid.size = {nx, ny, nz};
        grid.values = std::move(values);
        return static_cast<Index>(scene.scalar_grids.size() - 1);
    }
    // Fills the cube [-1, 1]^3 with a grid of one density.
    GridMedium grid_medium(Index density) const {
        GridMedium m;
        m.box.p0 = {-1, -1, -1};
        m.box.p1 = {1, 1, 1};
        m.density = density;
        return m;
    }
};

struct VolumeWorld {
    explicit VolumeWorld(const SceneDescription& d)
        : description(d), tables(description.scene, description.integrator.environments()),
          accelerator(tables.view()), camera(description.scene.camera, 16, 16) {}

    SceneDescription description;
    SceneTables tables;
    Accelerator accelerator;
    Camera camera;
};

// Radiance at four fixed wavelengths.
struct SpectralMean {
    SampledWavelengths lambda;
    std::array<RunningMoments, 4> moments;
    RunningMoments total; // of their mean: what they estimate together
};

inline SampledWavelengths rotated(const SampledWavelengths& w, int by) {
    SampledWavelengths r = w;
    for (int k = 0; k < 4; ++k) {
        r.lambda[k] = w.lambda[(k + by) % 4];
        r.pdf.set(k, w.pdf[(k + by) % 4]);
    }
    return r;
}

// Each of the wavelengths is the first one equally often: only then is the mean right.
template <typename Integrator>
SpectralMean radiance_along(const VolumeWorld& world, const Ray& ray, int samples, float u_lambda = 0.37f) {
    const Integrator integrator(world.description.integrator, world.camera);
    RayTracer tracer(world.accelerator);
    SpectralMean mean;
    mean.lambda = SampledWavelengths::sample_visible(u_lambda);
    for (int i = 0; i < samples / 4; ++i) {
        SampledSpectrum sum;
        for (int by = 0; by < 4; ++by) {
            const SampledWavelengths lambda = rotated(mean.lambda, by);
            SampleStream stream({.seed = 11}, static_cast<std::uint32_t>(by), 0,
                                static_cast<std::uint64_t>(i));
            const FilmContribution c =
                integrator.estimate(world.tables.view(), tracer, {ray, lambda}, stream);
            const float scale = c.lambda.secondary_terminated() ? 4.0f : 1.0f;
            for (int k = 0; k < 4; ++k)
                if (c.lambda.pdf[k] != 0)
                    sum.set((k + by) % 4, sum[(k + by) % 4] + 0.25f * scale * c.radiance[k]);
        }
        for (int k = 0; k < 4; ++k) mean.moments[static_cast<std::size_t>(k)].add(double(sum[k]));
        mean.total.add(double(average(sum)));
    }
    return mean;
}
inline SpectralMean volume_radiance(const SceneDescription& d, const Ray& ray, int samples) {
    return radiance_along<VolumePathIntegrator>(VolumeWorld(d), ray, samples);
}

// Five standard errors: a false alarm in 1.7 million. truth(wavelength in nm).
template <typename Truth>
void expect_radiance(const SpectralMean& mean, const Truth& truth, const std::string& what,
                     double tolerance = 1e-5) {
    for (int k = 0; k < 4; ++k) {
        const RunningMoments& m = mean.moments[static_cast<std::size_t>(k)];
        const double t = truth(mean.lambda.lambda[k]);
        EXPECT_NEAR(m.mean(), t, 5 * std::sqrt(m.variance_of_mean()) + tolerance * std::abs(t))
            << what << ", " << mean.lambda.lambda[k] << " nm";
    }
}

// All wavelengths together, over the pixels of the scene's camera.
template <typename Integrator>
RunningMoments camera_mean(const VolumeWorld& world, const IntegratorSettings& settings, int samples,
                           std::uint64_t seed) {
    const Integrator integrator(settings, world.camera);
    RayTracer tracer(world.accelerator);
    RunningMoments mean;
    for (int i = 0; i < samples; ++i) {
        SampleStream stream({.seed = seed}, 0, 0, static_cast<std::uint64_t>(i));
        const Vec2f film = stream.next_2d() * 16;
        const auto lambda = SampledWavelengths::sample_visible(stream.next_1d());
        const FilmContribution c = integrator.estimate(world.tables.view(), tracer,
                                                       {world.camera.generate_ray(film, {}), lambda}, stream);
        mean.add(double(average(safe_div(c.radiance, c.lambda.pdf))));
    }
    return mean;
}
template <typename Integrator>
RunningMoments camera_mean(const SceneDescription& description, int samples, std::uint64_t seed) {
    const VolumeWorld world(description);
    return camera_mean<Integrator>(world, world.description.integrator, samples, seed);
}

inline void expect_same_mean(const RunningMoments& a, const RunningMoments& b, const std::string& what) {
    EXPECT_GT(a.mean(), 0);
    EXPECT_NEAR(a.mean(), b.mean(), 5 * std::sqrt(a.variance_of_mean() + b.variance_of_mean())) << what;
}

constexpr Strategy volume_strategies[] = {Strategy::uniform, Strategy::bsdf, Strategy::light, Strategy::mis};

} // namespace montelux::testing
