// The background that the camera sees in place of infinite lights.
#include "test/render/layer_testing.h"
#include <gtest/gtest.h>

#include "montelux/render/film_exposure.h"

namespace montelux::testing {
namespace {

constexpr Vec3f blue{0.25f, 0.5f, 2};

double channel_mean(const Film& film, int x, int y, int c) { return film.pixel(x, y).replicates().mean(c); }

// Through vacuum and through fog, and with ambient occlusion.
TEST(Background, ReplacesLightForTheCameraAlone) {
    SceneBuilder plain = square_below();
    plain.description.film.layers.set = LayerSet::standard();
    SceneBuilder fog = plain;
    fog.scene.media.emplace_back(HomogeneousMedium{});
    std::get<HomogeneousMedium>(fog.scene.media.back()).sigma_a = {0.25f};
    std::get<HomogeneousMedium>(fog.scene.media.back()).sigma_s = {0};
    SceneBuilder occlusion = plain;
    occlusion.description.integrator.occlusion.emplace();
    for (SceneBuilder* b : {&plain, &fog, &occlusion}) {
        const Film before = render(b->description);
        b->description.integrator.background = blue;
        const Film after = render(b->description);
        for (int c = 0; c < 3; ++c) {
            // Exact, without noise.
            EXPECT_EQ(channel_mean(after, 0, 0, c), double(blue[c])) << c;
            EXPECT_EQ(after.pixel(0, 0).replicates().variance(c), 0);
            // The square is lit as before.
            EXPECT_EQ(channel_mean(after, 8, 8, c), channel_mean(before, 8, 8, c)) << c;
            EXPECT_GT(channel_mean(after, 8, 8, c), 0.1);
        }
    }
    // A mirror still shows the light.
    SceneBuilder mirror = square_below();
    mirror.scene.materials[0] = ConductorMaterial{};
    const Film before = render(mirror.description);
    mirror.description.integrator.background = blue;
    EXPECT_EQ(channel_mean(render(mirror.description), 8, 8, 0), channel_mean(before, 8, 8, 0));
}

// As much of it as the layer alpha leaves.
TEST(Background, IsSeenThroughWhatIsThin) {
    SceneBuilder b = square_below();
    b.scene.shapes[0].alpha = {0.25f};
    b.scene.lights.clear();
    b.description.film.layers.set = {Layer::alpha};
    b.description.sampler.spp = 256;
    b.description.integrator.background = blue;
    const RenderState state = render_state(b.description);
    const Image image = state.film.develop();
    double stopped = 0;
    for (int y = 6; y < 10; ++y)
        for (int x = 6; x < 10; ++x) {
            const float alpha = value_of(image, x, y, "A");
            EXPECT_NEAR(value_of(image, x, y, "B"), (1 - alpha) * blue.z, 1e-5);
            stopped += double(alpha) / 16;
        }
    EXPECT_NEAR(stopped, 0.25, 0.05);
}

// The exposure is of light; a colour that a user gives is meant as it is.
TEST(Background, IsNotExposed) {
    SceneBuilder b = square_below();
    b.description.film.layers.set = LayerSet::standard();
    b.description.film.iso = 800;
    b.description.film.max_component_value = 0.125f;
    b.description.integrator.background = blue;
    const Film film = render(b.description);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(channel_mean(film, 0, 0, c), double(blue[c]));
    EXPECT_LE(channel_mean(film, 8, 8, 1), 0.126);
}

// Negative filter weights apply to the background, too, so that edges keep their brightness.
TEST(Background, IsWeighedAsLightByFiltersWithNegativeLobes) {
    SceneDescription d = square_below().description;
    d.integrator.background = blue;
    FilmContribution path;
    path.transparency = 0.5f;
    const auto background = [&](const PixelFilter& filter, float weight) {
        d.film.filter = filter;
        return FilmExposure(d)(path, 1, weight).rgb;
    };
    for (const PixelFilter& filter : {PixelFilter(MitchellFilter{}), PixelFilter(LanczosFilter{})})
        for (const float weight : {1.25f, -1.25f})
            for (int c = 0; c < 3; ++c) EXPECT_EQ(background(filter, weight)[c], 0.5f * weight * blue[c]);
    // Weights of other filters are 1 up to rounding, which is not applied to a constant background.
    for (const PixelFilter& filter :
         {PixelFilter(BoxFilter{}), PixelFilter(TriangleFilter{}), PixelFilter(GaussianFilter{})})
        for (int c = 0; c < 3; ++c) EXPECT_EQ(background(filter, 1.0625f)[c], 0.5f * blue[c]);
}

} // namespace
} // namespace montelux::testing
