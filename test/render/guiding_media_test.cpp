// Guided renders of media: phase functions and surfaces learn where light comes from.
#include "test/render/hidden_lamp.h"
#include "test/transport/volume_testing.h"
#include <gtest/gtest.h>

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::testing {
namespace {

// The room of the hidden lamp in fog, which scatters forward and whose extinction depends on the wavelength.
SceneBuilder foggy_hidden_lamp(int size) {
    SceneBuilder b = hidden_lamp(size);
    HomogeneousMedium fog{.sigma_a = add_spectrum(b.scene, line(0.02f, 0.05f)),
                          .sigma_s = add_spectrum(b.scene, line(0.2f, 0.1f))};
    fog.phase = HenyeyGreenstein{0.4f};
    b.scene.media.push_back(fog);
    b.scene.camera.medium = 0;
    return b;
}
// Black walls and a wide slit: hardly anything but fog scatters.
SceneBuilder black_hidden_lamp(int size) {
    SceneBuilder b = hidden_lamp(size, 0.02f, 0.8);
    b.scene.media.push_back(HomogeneousMedium{.sigma_a = 0.02f, .sigma_s = 1.0f});
    b.scene.camera.medium = 0;
    b.description.integrator.max_depth = 20;
    return b;
}

void expect_guiding_helps(SceneBuilder b, double least) {
    b.description.sampler.spp = 256;
    const RenderState plain = render_guided(b.description);
    b.description.integrator.guiding = Guiding::on;
    const RenderState guided = render_guided(b.description);
    ASSERT_NE(guided.guide, nullptr);
    EXPECT_NE(guided.guide->find({-0.5f, 0, 0}, Facing::medium), nullptr);
    const double before = plain.film.error().relative, after = guided.film.error().relative;
    EXPECT_GT(before * before / (after * after), least) << before << ' ' << after;
}
TEST(GuidingMedia, PhaseFunctionsFindHiddenLight) { expect_guiding_helps(black_hidden_lamp(22), 2); }
TEST(GuidingMediaSlowTest, FogAndWallsFindHiddenLight) { expect_guiding_helps(foggy_hidden_lamp(32), 1.7); }

// With interfaces, a grid and lamps that equiangular sampling finds.
VolumeScene cloud_beside_lamp() {
    VolumeScene b;
    std::vector<float> values;
    for (int i = 0; i < 120; ++i) values.push_back(0.2f * static_cast<float>(i * 7 % 5));
    GridMedium m = b.grid_medium(b.add_grid(4, 5, 6, values));
    m.sigma_a = b.spectrum(0.3f, 0.05f);
    m.sigma_s = b.spectrum(0.8f, 3);
    m.phase = HenyeyGreenstein{0.3f};
    m.le = b.spectrum(0.05f, 0.02f);
    b.add_cube(b.add_medium(m));
    const Transform t = Transform::translate({0.3, -0.2, 1.4});
    b.add_quadric(Sphere{.radius = 0.1f, .z_min = -0.1f, .z_max = 0.1f, .world_from_object = t},
                  b.add(DiffuseMaterial{gray(0)}), 30);
    b.add_mesh(square(Transform::translate({0, 0, -1.2}) * Transform::scale({3, 3, 1})),
               b.add(DiffuseMaterial{gray(0.6f)}));
    b.add_uniform_light(0.2f);
    b.look({0.3, -4, 0.6}, {0, 0, 0}, 35);
    b.description.film.width = b.description.film.height = 16;
    b.description.film.crop = {0, 0, 16, 16};
    b.description.integrator.max_depth = 20;
    return b;
}

TEST(GuidingMediaSlowTest, IsUnbiasedInFog) { expect_guiding_is_unbiased(foggy_hidden_lamp(32)); }
TEST(GuidingMedia, IsUnbiasedInClouds) { expect_guiding_is_unbiased(cloud_beside_lamp()); }

// A floor like a blurred mirror.
SceneBuilder polished_hidden_lamp(bool fog) {
    SceneBuilder b = fog ? foggy_hidden_lamp(32) : hidden_lamp(22);
    const RoughnessParameter polished{FloatParameter{0.1f}, FloatParameter{0.1f}, false};
    const Index metal =
        b.add(ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(4)}, .roughness = polished});
    b.scene.shapes[0].material = metal;
    return b;
}
TEST(Guiding, IsUnbiasedBesidePolishedMetal) { expect_guiding_is_unbiased(polished_hidden_lamp(false)); }
TEST(GuidingMediaSlowTest, IsUnbiasedBesidePolishedMetal) {
    expect_guiding_is_unbiased(polished_hidden_lamp(true));
}

TEST(GuidingMedia, AnyNumberOfThreads) {
    SceneBuilder b = foggy_hidden_lamp(16);
    b.description.sampler.spp = 16;
    b.description.integrator.guiding = Guiding::on;
    std::vector<RenderState> states;
    for (int threads : {1, 2, 7})
        with_threads(threads, [&] { states.push_back(render_guided(b.description)); });
    for (std::size_t s = 1; s < states.size(); ++s)
        for (std::size_t i = 0; i < states[0].film.pixels().size(); ++i)
            ASSERT_TRUE(same_pixel(states[0].film.pixels()[i], states[s].film.pixels()[i]));
}

} // namespace
} // namespace montelux::testing
