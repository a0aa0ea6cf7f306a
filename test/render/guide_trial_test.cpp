// What --guiding auto spends on finding out whether a guide pays.
#include "test/render/hidden_lamp.h"
#include <cstdint>
#include <gtest/gtest.h>
#include <utility>

#include "montelux/render/guide_training.h"

namespace montelux::testing {
namespace {

// A plane under a sky, which leaves a guide nothing to find.
SceneBuilder open_plane(int size) {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({100, 100, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    b.add_uniform_light(1);
    b.look({0, -0.5, 5}, {0, 0, 0}, 20);
    b.description.film.width = b.description.film.height = size;
    b.description.film.crop = {0, 0, size, size};
    return b;
}

GuideSummary trial(SceneBuilder b, GuideTrainingPlan plan, std::uint64_t memory = 256) {
    b.description.integrator.guiding = Guiding::automatic;
    b.description.integrator.guiding_memory = memory;
    const Renderer renderer(b.description);
    SampleContext context(b.description, renderer.sampler(), renderer.scene(), renderer.camera());
    plan.bounds = b.description.film.crop;
    const TrainedGuide trained = train_guide(context, renderer.accelerator(), b.description.integrator, plan);
    EXPECT_TRUE(trained.summary.decided);
    EXPECT_EQ(trained.guide != nullptr, trained.summary.outcome == GuideOutcome::trained);
    EXPECT_EQ(trained.guide, context.guide());
    return trained.summary;
}

TEST(GuideTrial, TakesASixtiethOfTheSamples) {
    const GuideSummary tried = trial(open_plane(64), {.bounds = {}, .samples = 448});
    EXPECT_EQ(tried.outcome, GuideOutcome::would_not_pay);
    EXPECT_EQ(tried.rounds, 3u);
    EXPECT_EQ(tried.samples, 7); // 14 would be a thirtieth
    EXPECT_GT(tried.gain, 0);
    EXPECT_LT(tried.gain, 0.85);
}

TEST(GuideTrial, TakesSomePixelsOfLargePictures) {
    for (const std::uint64_t samples : {23, 32, 52}) {
        const GuideSummary tried = trial(open_plane(192), {.bounds = {}, .samples = samples});
        EXPECT_EQ(tried.outcome, GuideOutcome::would_not_pay);
        EXPECT_EQ(tried.rounds, 2u) << samples;
        EXPECT_NEAR(tried.samples, 3.0 / 8, 0.01);
    }
    EXPECT_EQ(trial(open_plane(192), {.bounds = {}, .samples = 53}).rounds, 3u);
    SceneBuilder cropped = open_plane(400);
    cropped.description.film.crop = {150, 101, 351, 302};
    EXPECT_NEAR(trial(cropped, {.bounds = {}, .samples = 32}).samples, 3.0 / 8, 0.01);
}

TEST(GuideTrial, ShortRendersAreNotTried) {
    for (const auto& [size, samples] : {std::pair{192, 22}, {64, 179}, {1, 179}}) {
        const GuideSummary tried = trial(open_plane(size), {.bounds = {}, .samples = std::uint64_t(samples)});
        EXPECT_EQ(tried.outcome, GuideOutcome::too_short);
        EXPECT_EQ(tried.rounds, 0u);
    }
    EXPECT_EQ(trial(open_plane(64), {.bounds = {}, .samples = 180}).rounds, 2u);
    EXPECT_EQ(trial(open_plane(64), {.bounds = {}, .samples = 1u << 20, .seconds = 1e-6}).outcome,
              GuideOutcome::too_short);
}

TEST(GuideTrial, TargetsDecideHowLongItIs) {
    double last = 0;
    for (const double error : {0.04, 0.02, 0.01}) { // four times the samples, two rounds more
        const GuideSummary tried = trial(open_plane(64), {.bounds = {}, .samples = 1u << 20, .error = error});
        EXPECT_EQ(tried.outcome, GuideOutcome::would_not_pay);
        EXPECT_GT(tried.samples, last);
        last = tried.samples;
    }
    EXPECT_LT(last, 250);
}

// The picture is that of a render that never tried.
TEST(GuideTrial, LeavesNoTrace) {
    SceneBuilder b = open_plane(64);
    b.description.sampler.spp = 192;
    const RenderState plain = render_guided(b.description);
    b.description.integrator.guiding = Guiding::automatic;
    const RenderState tried = render_guided(b.description);
    EXPECT_EQ(tried.report.guide.outcome, GuideOutcome::would_not_pay);
    EXPECT_EQ(tried.report.guide.rounds, 2u);
    EXPECT_EQ(tried.guide, nullptr);
    for (std::size_t i = 0; i < plain.film.pixels().size(); ++i)
        ASSERT_TRUE(same_pixel(plain.film.pixels()[i], tried.film.pixels()[i]));
}

// Its gain is small after the trial, and large after a sixth of the samples.
TEST(GuideTrial, GuidesThatGrowAreTrainedFurther) {
    const GuideSummary kept = trial(hidden_lamp(96), {.bounds = {}, .samples = 256});
    EXPECT_EQ(kept.outcome, GuideOutcome::trained);
    EXPECT_GT(kept.samples, 256.0 / 12);
    EXPECT_GT(kept.gain, 2);
}

TEST(GuideTrial, EndsWhenTheMemoryIsFull) {
    const GuideTrainingPlan plan{.bounds = {}, .samples = 1u << 20, .error = 0.01};
    EXPECT_GE(trial(open_plane(64), plan).rounds, 4u);
    const GuideSummary tried = trial(open_plane(128), plan, 1);
    EXPECT_EQ(tried.outcome, GuideOutcome::would_not_pay);
    EXPECT_EQ(tried.rounds, 3u);
    const GuideSummary kept = trial(hidden_lamp(64), {.bounds = {}, .samples = 1u << 11}, 8);
    EXPECT_EQ(kept.outcome, GuideOutcome::trained);
    EXPECT_EQ(kept.rounds, 3u);
}

TEST(GuideTrial, WithoutLightNothingIsLearned) {
    SceneBuilder b;
    b.add_mesh(square(Transform()), b.add(DiffuseMaterial{gray(0.6f)}));
    b.look({0, -0.5, 5}, {0, 0, 0}, 20);
    EXPECT_EQ(trial(std::move(b), {.bounds = {}, .samples = 1024}).outcome, GuideOutcome::nothing_found);
}

} // namespace
} // namespace montelux::testing
