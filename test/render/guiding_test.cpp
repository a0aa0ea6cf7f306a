// Guided renders: the same picture with less noise, whatever the guide has learned.
#include "test/render/hidden_lamp.h"
#include "test/render/mixed_scene.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <gtest/gtest.h>
#include <memory>
#include <utility>
#include <vector>

#include "montelux/film/pixel_warnings.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/stats/z_test.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/guide_training.h"

namespace montelux::testing {
namespace {

TEST(Guiding, FindsHiddenLightFarBetter) {
    SceneBuilder b = hidden_lamp(28);
    b.description.sampler.spp = 256;
    const RenderState plain = render_guided(b.description);
    b.description.integrator.guiding = Guiding::on;
    const RenderState guided = render_guided(b.description);
    EXPECT_NE(guided.guide, nullptr);
    EXPECT_GE(guided.report.guide.rounds, 3u);
    EXPECT_GT(guided.report.guide.gain, 1);
    const double before = plain.film.error().relative, after = guided.film.error().relative;
    EXPECT_LT(after * after, before * before / 3) << before << " " << after;
}

TEST(Guiding, IsUnbiased) {
    for (const SceneBuilder& b : {hidden_lamp(24), mixed_scene(1, 24, 24)}) expect_guiding_is_unbiased(b);
}

// Each pixel of each render against the mean of the renders with other seeds, which have other guides. Shares of scores
// below one and two by seed, beside those of Student's law: that of the difference's variance, to which the others add
// little (Welch 1947).
struct GuidedShares {
    RunningMoments one, two;
    double expected_one = 0, expected_two = 0;
    double marked = 0; // share of the pixels whose error is called unreliable, left out
};
GuidedShares guided_shares(SceneDescription d, std::uint32_t spp, std::uint64_t seeds) {
    d.integrator.guiding = Guiding::on;
    d.sampler.spp = spp;
    const auto prepared = std::make_shared<const PreparedScene>(d);
    std::vector<Film> films;
    for (d.sampler.seed = 0; d.sampler.seed < seeds; ++d.sampler.seed) {
        RenderState state(d);
        Renderer(d, {}, 0, prepared).render(state);
        EXPECT_NE(state.guide, nullptr);
        films.push_back(std::move(state.film));
    }
    const std::size_t pixels = films[0].pixels().size();
    std::vector<double> mean(pixels), variance(pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        for (const Film& film : films) {
            mean[p] += film.pixels()[p].replicates().mean(1);
            variance[p] += film.pixels()[p].replicates().variance_of_mean(1);
        }
    GuidedShares r;
    const double others = double(seeds) - 1;
    for (const Film& film : films) {
        const std::vector<PixelWarning> warnings = pixel_warnings(film);
        double one = 0, two = 0, count = 0;
        for (std::size_t p = 0; p < pixels; ++p) {
            if (marks_unreliable_error(warnings[p])) continue;
            const SkewMoments<3>& m = film.pixels()[p].replicates();
            const double v = m.variance_of_mean(1);
            const double t = std::abs(m.mean(1) - (mean[p] - m.mean(1)) / others) /
                             std::sqrt(v + (variance[p] - v) / (others * others));
            one += t < 1;
            two += t < 2;
            ++count;
        }
        r.one.add(one / count);
        r.two.add(two / count);
        r.marked += (1 - count / double(pixels)) / double(seeds);
    }
    const double freedom = spp - 1.0;
    r.expected_one = 1 - 2 * student_t_cdf(-1, freedom);
    r.expected_two = 1 - 2 * student_t_cdf(-2, freedom);
    return r;
}

void expect_guided_calibration(const SceneBuilder& b, std::uint32_t spp, std::uint64_t seeds) {
    const GuidedShares s = guided_shares(b.description, spp, seeds);
    std::printf("within 1 error %.3f +- %.3f (%.3f), within 2 %.3f +- %.3f (%.3f), marked %.2f\n",
                s.one.mean(), s.one.standard_error(), s.expected_one, s.two.mean(), s.two.standard_error(),
                s.expected_two, s.marked);
    EXPECT_NEAR(s.one.mean(), s.expected_one, 0.01 + 4 * s.one.standard_error());
    EXPECT_NEAR(s.two.mean(), s.expected_two, 0.005 + 4 * s.two.standard_error());
    EXPECT_LT(s.marked, 0.5);
}

// The second scene has less skewed samples: there errors that are too small or too large by a tenth are seen.
TEST(Guiding, ErrorsOfPixelsAreCalibrated) {
    expect_guided_calibration(hidden_lamp(6, 0.7f, 0.8), 384, 16);
    expect_guided_calibration(mixed_scene(1, 12, 12), 64, 36);
}

TEST(Guiding, AnyNumberOfThreads) {
    SceneBuilder b = hidden_lamp(20);
    b.description.sampler.spp = under_sanitizers ? 8 : 32;
    b.description.integrator.guiding = Guiding::on;
    std::vector<RenderState> states;
    for (int threads : {1, 2, 7})
        with_threads(threads, [&] { states.push_back(render_guided(b.description)); });
    for (std::size_t s = 1; s < states.size(); ++s)
        for (std::size_t i = 0; i < states[0].film.pixels().size(); ++i)
            ASSERT_TRUE(same_pixel(states[0].film.pixels()[i], states[s].film.pixels()[i]));
}

TEST(Guiding, InterruptedRendersEndWithTheSameBits) {
    TemporaryFolder folder;
    const std::filesystem::path path = folder / "guided.state";
    SceneBuilder b = hidden_lamp(20);
    b.description.sampler.spp = 40;
    b.description.integrator.guiding = Guiding::on;
    const RenderState whole = render_guided(b.description);
    for (const std::uint64_t after : {400u, 401u, 3000u}) {
        RenderState state(b.description);
        {
            const Renderer renderer(b.description);
            CancelFlag cancel;
            RenderControl control;
            control.cancel = &cancel;
            control.progress = [&](const RenderProgress& p) {
                if (p.samples_done >= after) cancel.request();
            };
            control.checkpoint = [&](const RenderState& s) { save_checkpoint(path, renderer, s); };
            renderer.render(state, control);
            ASSERT_TRUE(state.report.cancelled());
        }
        RestoredRender restored = load_checkpoint(path, b.description, {});
        SceneDescription description = b.description;
        description.sampler.replicate_points = restored.replicate_points;
        Renderer(description).render(restored.state);
        for (std::size_t i = 0; i < whole.film.pixels().size(); ++i)
            ASSERT_TRUE(same_pixel(whole.film.pixels()[i], restored.state.film.pixels()[i])) << after;
    }
    b.description.integrator.guiding = Guiding::off;
    EXPECT_THROW(load_checkpoint(path, b.description, {}), Error);
}

// A training that is cancelled leaves no guide and no decision: the render that goes on trains anew.
TEST(Guiding, CancelledTrainingsDecideNothing) {
    SceneBuilder b = hidden_lamp(20);
    b.description.integrator.guiding = Guiding::on;
    const Renderer renderer(b.description);
    SampleContext context(b.description, renderer.sampler(), renderer.scene(), renderer.camera());
    CancelFlag cancel;
    const GuideTrainingPlan plan{.bounds = b.description.film.crop, .samples = 64, .cancel = &cancel};
    const IntegratorSettings& settings = b.description.integrator;
    EXPECT_TRUE(train_guide(context, renderer.accelerator(), settings, plan).summary.decided);
    EXPECT_NE(context.guide(), nullptr);
    context.set_guide(nullptr);
    cancel.request();
    const TrainedGuide trained = train_guide(context, renderer.accelerator(), settings, plan);
    EXPECT_FALSE(trained.summary.decided);
    EXPECT_EQ(trained.guide, nullptr);
    EXPECT_EQ(context.guide(), nullptr);
}

// Cancelled when the training is due: the resumed render trains before it takes more samples.
TEST(Guiding, RendersCancelledBeforeTheTrainingEndWithTheSameBits) {
    SceneBuilder b = hidden_lamp(20);
    b.description.sampler.spp = 32;
    b.description.integrator.guiding = Guiding::on;
    const RenderState whole = render_guided(b.description);
    CancelFlag cancel;
    RenderState saved(b.description);
    RenderControl control;
    control.cancel = &cancel;
    control.checkpoint_seconds = 0;
    control.checkpoint = [&](const RenderState& s) {
        saved = s;
        if (s.report.samples == 400) cancel.request();
    };
    render_guided(b.description, control);
    EXPECT_EQ(saved.report.samples, 400u);
    EXPECT_EQ(saved.target_samples.front(), 1u); // the next round is not chosen
    EXPECT_FALSE(saved.report.guide.decided);
    EXPECT_NE(whole.guide, nullptr);
    Renderer(b.description).render(saved);
    int differing = 0;
    for (std::size_t i = 0; i < whole.film.pixels().size(); ++i)
        differing += !same_pixel(whole.film.pixels()[i], saved.film.pixels()[i]);
    EXPECT_EQ(differing, 0);
}

TEST(Guiding, AutomaticStaysWhereItWins) {
    SceneBuilder b = hidden_lamp(48);
    b.description.sampler.spp = 224;
    b.description.integrator.guiding = Guiding::automatic;
    const RenderState state = render_guided(b.description);
    ASSERT_NE(state.guide, nullptr) << state.report.guide.gain << " after " << state.report.guide.samples;
    EXPECT_GE(state.report.guide.rounds, 3u);
    EXPECT_GT(state.report.guide.gain, 1.1);
    EXPECT_LT(state.report.guide.gain, 30);
}

TEST(Guiding, WithoutLightThereIsNoGuide) {
    SceneBuilder b;
    b.add_mesh(square(Transform()), b.add(DiffuseMaterial{gray(0.6f)}));
    b.look({0, -0.5, 5}, {0, 0, 0}, 20);
    b.description.integrator.guiding = Guiding::on;
    const RenderState state = render_guided(b.description);
    EXPECT_EQ(state.guide, nullptr);
    EXPECT_TRUE(state.report.guide.decided);
    EXPECT_EQ(mean_luminance(state.film), 0);
}

TEST(Guiding, WhatCannotBeGuidedSaysSo) {
    SceneBuilder b = hidden_lamp(8);
    b.description.integrator.guiding = Guiding::on;
    b.description.integrator.occlusion.emplace();
    EXPECT_THROW(render_guided(b.description), Error);
    b.description.integrator.guiding = Guiding::automatic;
    EXPECT_EQ(render_guided(b.description).guide, nullptr);
    b.description.integrator.occlusion.reset();
    b.description.integrator.guiding = Guiding::on;
    b.description.integrator.strategy = Strategy::uniform;
    EXPECT_THROW(render_guided(b.description), Error);
    EXPECT_THROW(Renderer(b.description).replay(1, 1, 0), Error);
}

} // namespace
} // namespace montelux::testing
