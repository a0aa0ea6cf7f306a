// Layers of light: direct and indirect light and the groups of lights sum to the mean, and are pictures of their own.
#include "test/render/hidden_lamp.h"
#include "test/render/layer_testing.h"
#include "test/render/seed_means.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/moments.h"

namespace montelux::testing {
namespace {

// Largest relative difference between the mean and the sum of layers.
double distance_from_mean(const Image& image, const std::vector<std::string>& layers) {
    double largest = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (const char* c : {"R", "G", "B"}) {
                double sum = 0, size = 0;
                for (const std::string& layer : layers) {
                    const double v = image.value(x, y, *image.find_channel(layer + "." + c));
                    sum += v;
                    size += std::abs(v);
                }
                const double mean = image.value(x, y, *image.find_channel(c));
                largest = std::max(largest, std::abs(sum - mean) / std::max({std::abs(mean), size, 1e-6}));
            }
    return largest;
}

TEST(Layers, DirectAndIndirectAndLightGroupsSumToTheMean) {
    for (const SceneBuilder& scene : {layered_scene(), foggy_scene()})
        for (const Strategy strategy : {Strategy::mis, Strategy::uniform, Strategy::mis_light}) {
            SceneDescription of_strategy = scene.description;
            of_strategy.integrator.strategy = strategy;
            const auto prepared = prepared_scene(of_strategy);
            for (const LightGrouping grouping : {LightGrouping::light, LightGrouping::kind}) {
                SceneBuilder b = scene;
                // The last replicate is shorter than the others.
                b.description.sampler = {.kind = SamplerKind::sobol, .spp = 44};
                b.description.integrator.strategy = strategy;
                b.description.film.filter = MitchellFilter{};
                b.description.film.max_component_value = 1.5f;
                b.description.film.layers.set = {Layer::direct, Layer::indirect, Layer::light_groups};
                b.description.film.layers.light_grouping = grouping;
                const RenderState state = render_state(b.description, prepared);
                const Image image = state.film.develop();
                EXPECT_LT(distance_from_mean(image, {"direct", "indirect"}), 1e-5);
                std::vector<std::string> groups;
                for (const std::string& group : state.film.layers().light_groups())
                    groups.push_back("light." + group);
                EXPECT_EQ(groups.size(), (grouping == LightGrouping::light ? 3u : 2u) + b.scene.media.size());
                EXPECT_LT(distance_from_mean(image, groups), 1e-5);
                if (strategy != Strategy::mis) continue;
                // None of them is the whole.
                for (const std::string& group : groups)
                    EXPECT_GT(distance_from_mean(image, {group}), 0.1) << group;
                EXPECT_GT(distance_from_mean(image, {"direct"}), 0.1);
            }
        }
}

// Each contribution of a path that a guide splits counts once, whichever branches begin after it.
TEST(Layers, OfGuidedPathsSumToTheMean) {
    for (SceneBuilder b : {hidden_lamp(12, 0.7f, 1), layered_scene(), foggy_scene()}) {
        b.description.sampler.spp = 64;
        b.description.integrator.guiding = Guiding::on;
        b.description.film.layers.set = {Layer::direct, Layer::indirect, Layer::light_groups};
        const RenderState state = render_state(b.description);
        ASSERT_NE(state.guide, nullptr);
        const Image image = state.film.develop();
        EXPECT_LT(distance_from_mean(image, {"direct", "indirect"}), 1e-5);
        std::vector<std::string> groups;
        for (const std::string& group : state.film.layers().light_groups())
            groups.push_back("light." + group);
        EXPECT_LT(distance_from_mean(image, groups), 1e-5);
    }
}

// Its light belongs to no lamp.
TEST(Layers, AmbientOcclusionHasThem) {
    SceneBuilder b = mixed_scene(1, 12, 12);
    b.description.sampler = {.kind = SamplerKind::independent, .spp = 16};
    b.description.film.layers.set = {Layer::direct, Layer::indirect, Layer::position, Layer::alpha,
                                     Layer::shape};
    const Image paths = render_state(b.description).film.develop();
    b.description.integrator.occlusion = OcclusionSettings{};
    const Image image = render_state(b.description).film.develop();
    EXPECT_LT(distance_from_mean(image, {"direct", "indirect"}), 1e-5);
    const auto at = [](const Image& picture, int x, int y, const char* channel) {
        return picture.value(x, y, *picture.find_channel(channel));
    };
    float largest = 0;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) {
            largest = std::max(largest, at(image, x, y, "direct.G"));
            EXPECT_EQ(at(image, x, y, "indirect.G"), 0);
            // The camera rays are the same.
            for (const char* channel : {"P.X", "P.Y", "P.Z", "A", "CryptoShape00.R", "CryptoShape00.G"})
                EXPECT_EQ(at(image, x, y, channel), at(paths, x, y, channel)) << channel;
        }
    EXPECT_GT(largest, 0.1f);
    b.description.film.layers.set.add(Layer::light_groups);
    EXPECT_THROW(Renderer{b.description}, Error);
}

// Light after at most one scattering event is what a path of one event finds, by the same random numbers.
TEST(Layers, DirectIsThePictureOfOneScatteringEvent) {
    SceneBuilder b = layered_scene();
    b.description.sampler = {.kind = SamplerKind::independent, .spp = 16};
    b.description.film.layers.set = {Layer::direct};
    const auto prepared = prepared_scene(b.description);
    const Image all = render_state(b.description, prepared).film.develop();
    b.description.integrator.max_depth = 1;
    const Image one = render_state(b.description, prepared).film.develop();
    for (int y = 0; y < all.height(); ++y)
        for (int x = 0; x < all.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                const float expected = one.value(x, y, c);
                EXPECT_NEAR(all.value(x, y, *all.find_channel(std::string("direct.") + "RGB"[c])), expected,
                            1e-5f * std::max(1.0f, std::abs(expected)));
            }
}

// Each group is the picture that its lights alone make.
TEST(Layers, LightGroupsAreThePicturesOfTheirLights) {
    SceneBuilder b = mixed_scene(1, 12, 12);
    b.description.sampler = {.kind = SamplerKind::independent, .spp = 400};
    b.description.film.layers.set = {Layer::light_groups};
    b.scene.light_groups = {"lamps", "lamps", "sky"};
    const RenderState state = render_state(b.description);
    const Image image = state.film.develop();
    SceneBuilder sky_only = mixed_scene(1, 12, 12);
    sky_only.description.sampler = {.kind = SamplerKind::independent, .spp = 400};
    sky_only.description.sampler.seed = 5;
    for (std::size_t i = 0; i < 2; ++i) std::get<AreaLight>(sky_only.scene.lights[i]).scale = 0;
    const Film alone = render(sky_only.description);
    double sum = 0;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) sum += image.value(x, y, *image.find_channel("light.sky.G"));
    const PictureMean expected = picture_mean(alone);
    // The error of the group is at most that of the whole picture.
    const double error = std::hypot(expected.standard_error, picture_mean(state.film).standard_error);
    EXPECT_NEAR(sum / 144, expected.mean, 5 * error);
    EXPECT_GT(expected.mean, 10 * error);
}

// Guided paths split and end by the light of all lamps; each group is still the picture of its own. Student's test of 16
// seeds at 7 standard errors (two-sided: 4e-6 each): light of more than 18 % of a group in another one is seen, and the
// test above sees lost light.
TEST(Layers, LightGroupsOfGuidedPathsAreThePicturesOfTheirLights) {
    const std::vector<std::string> groups = {"hidden", "near"};
    SceneBuilder b = hidden_lamp(12);
    b.add_mesh(square(Transform::translate({-0.5, 0.2, 0.95}) * Transform::rotate(180, {1, 0, 0}) *
                      Transform::scale({0.1, 0.1, 1})),
               b.add(DiffuseMaterial{gray(0)}), 4);
    b.scene.light_groups = groups;
    SceneDescription d = b.description;
    d.sampler.spp = 112;
    d.integrator.guiding = Guiding::on;
    d.film.layers.set = {Layer::light_groups};
    std::vector<RunningMoments> guided(groups.size());
    constexpr int seeds = 16;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        d.sampler.seed = seed;
        const RenderState state = render_state(d);
        ASSERT_NE(state.guide, nullptr);
        const Image image = state.film.develop();
        for (std::size_t g = 0; g < groups.size(); ++g) {
            double sum = 0;
            for (int y = 0; y < 12; ++y)
                for (int x = 0; x < 12; ++x)
                    sum += image.value(x, y, *image.find_channel("light." + groups[g] + ".G"));
            guided[g].add(sum / 144);
        }
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
        SceneBuilder alone = b;
        std::get<AreaLight>(alone.scene.lights[1 - g]).scale = 0;
        alone.description.sampler.seed = 1000;
        const std::uint32_t spp = groups[g] == "hidden" ? 400 : 32; // paths without a guide rarely find it
        const RunningMoments expected =
            render_of_seeds(alone.description, IntegratorKind::path, spp, seeds).channel[1];
        const double error = std::hypot(guided[g].standard_error(), expected.standard_error());
        EXPECT_NEAR(guided[g].mean(), expected.mean(), 7 * error) << groups[g];
        EXPECT_LT(error, 0.025 * expected.mean()) << groups[g];
        EXPECT_GT(std::abs(guided[1 - g].mean() - expected.mean()), 7 * error) << groups[g];
    }
}

} // namespace
} // namespace montelux::testing
