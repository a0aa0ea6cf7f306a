// Guided renders: the same picture with less noise, whatever the guide has learned.
#include "test/render/hidden_lamp.h"
#include "test/render/mixed_scene.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/z_test.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/guide_training.h"

namespace montelux::testing {
namespace {

TEST(Guiding, FindsHiddenLightFarBetter) {
    SceneBuilder b = hidden_lamp(40);
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

// An evenly lit floor leaves nothing to learn: the picture is that of a render that never tried.
TEST(Guiding, AutomaticGivesUpWhereItCannotWin) {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({100, 100, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    b.add_uniform_light(1);
    b.look({0, -0.5, 5}, {0, 0, 0}, 20);
    b.description.film.width = b.description.film.height = 64;
    b.description.film.crop = {0, 0, 64, 64};
    b.description.sampler.spp = 64;
    const RenderState plain = render_guided(b.description);
    b.description.integrator.guiding = Guiding::automatic;
    const RenderState tried = render_guided(b.description);
    EXPECT_TRUE(tried.report.guide.decided);
    EXPECT_EQ(tried.guide, nullptr);
    for (std::size_t i = 0; i < plain.film.pixels().size(); ++i)
        ASSERT_TRUE(same_pixel(plain.film.pixels()[i], tried.film.pixels()[i]));
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
