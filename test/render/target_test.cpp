// Renders with a target error or a time limit: they reach it, without bias, and report why they stopped.
#include "test/render/mixed_scene.h"
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/moments.h"

namespace montelux::testing {
namespace {

RenderState run(const SceneDescription& description, const RenderTarget& target,
                std::shared_ptr<const PreparedScene> prepared = nullptr) {
    RenderState state(description.film);
    Renderer(description, target, 0, std::move(prepared)).render(state);
    return state;
}

TEST(Target, ErrorIsReachedAndNotOvershot) {
    SceneBuilder b = mixed_scene(1, 32, 32);
    const auto prepared = prepared_scene(b.description);
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol})
        for (bool adaptive : {false, true}) {
            b.description.sampler.kind = kind;
            b.description.sampler.spp = 1u << 16;
            const RenderState state = run(b.description, {.error = 0.06, .adaptive = adaptive}, prepared);
            EXPECT_EQ(state.report.stop, RenderStop::error);
            const FilmError e = state.film.error();
            EXPECT_LE(e.relative, 0.06);
            EXPECT_GT(e.relative, 0.06 * (adaptive ? 0.85 : 0.7)) << int(kind);
            std::uint64_t samples = 0;
            for (const Pixel& p : state.film.pixels()) samples += p.samples();
            EXPECT_EQ(samples, state.report.samples);
        }
}

// A picture so small that its error is computed from few replicates: checked after each, an error that is
// small by chance would end the render far too early. The targets are shares of the error after 16 samples.
TEST(Target, FewReplicatesAreNotBelieved) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 1;
    b.description.film.crop = {0, 0, 1, 1};
    b.add_quadric(Sphere{}, b.add(DiffuseMaterial{gray(0.5f)}));
    b.add_uniform_light(1);
    b.look({0, 0, 5}, {0, 0, 0}, 40);
    b.description.sampler = {SamplerKind::sobol, 1, 1u << 15};
    const auto prepared = prepared_scene(b.description);
    const RenderTarget endless{.error = 1e-9};
    const RenderState truth = run(b.description, endless, prepared);
    const SkewMoments<3>& replicates = truth.film.pixels()[0].replicates();
    ASSERT_EQ(replicates.count(), (1u << 15) / 8);
    auto luminance = [](const Film& film) { return film.error().mean_luminance; };
    const double after_16 =
        truth.film.error().relative * std::sqrt(static_cast<double>(replicates.count()) / 2);
    for (double target : {after_16 / 3, after_16 / 6})
        for (bool adaptive : {false, true}) {
            RunningMoments squares;
            int at_once = 0;
            for (std::uint64_t seed = 100; seed < 900; ++seed) {
                b.description.sampler.seed = seed;
                const RenderState state =
                    run(b.description, {.error = target, .adaptive = adaptive}, prepared);
                EXPECT_EQ(state.report.stop, RenderStop::error);
                at_once += state.report.samples <= 32;
                squares.add(std::pow(luminance(state.film) / luminance(truth.film) - 1, 2));
            }
            const double ratio = std::sqrt(squares.mean()) / target;
            RecordProperty("true error in % of the target", static_cast<int>(100 * ratio));
            EXPECT_GT(ratio, 0.8) << adaptive;
            EXPECT_LT(ratio, 1.2) << adaptive;
            EXPECT_EQ(at_once, 0) << adaptive;
        }
}

TEST(Target, SamplesThatRunOutAreSaid) {
    SceneBuilder b = mixed_scene(1, 16, 16);
    b.description.sampler.spp = 32;
    const auto prepared = prepared_scene(b.description);
    for (bool adaptive : {false, true}) {
        const RenderState state = run(b.description, {.error = 1e-4, .adaptive = adaptive}, prepared);
        EXPECT_EQ(state.report.stop, RenderStop::samples);
        EXPECT_LE(state.report.samples, 32u * 256);
        EXPECT_GE(state.report.samples, 28u * 256);
    }
}

TEST(Target, TimeEndsTheRenderWithAValidFilm) {
    SceneBuilder b = mixed_scene(1, 16, 16);
    b.description.sampler.spp = 1u << 24;
    const RenderState state = run(b.description, {.time = 0.3});
    EXPECT_EQ(state.report.stop, RenderStop::time);
    EXPECT_GE(state.report.seconds, 0.3);
    EXPECT_TRUE(std::isfinite(state.film.error().relative));
}

TEST(Target, QuantileOfThePixels) {
    SceneBuilder b = mixed_scene(1, 24, 24);
    b.description.sampler.kind = SamplerKind::independent;
    b.description.sampler.spp = 1u << 16;
    const RenderState state = run(b.description, {.error = 0.08, .quantile = 0.9});
    EXPECT_EQ(state.report.stop, RenderStop::error);
    int within = 0;
    const FilmError e = state.film.error();
    for (const Pixel& p : state.film.pixels()) within += luminance_error(p) <= 0.08 * e.mean_luminance;
    EXPECT_GE(within, 0.9 * 24 * 24);
    EXPECT_LT(within, 0.97 * 24 * 24);
}

// Nothing seen yet is not an error of zero.
TEST(Target, BlackPicturesAreNotDoneAtOnce) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 4;
    b.description.film.crop = {0, 0, 4, 4};
    for (bool adaptive : {false, true}) {
        b.description.sampler.spp = 256;
        const RenderState few = run(b.description, {.error = 0.05, .adaptive = adaptive});
        EXPECT_EQ(few.report.stop, RenderStop::samples);
        b.description.sampler.spp = 1u << 20;
        const RenderState many = run(b.description, {.error = 0.05, .adaptive = adaptive});
        EXPECT_EQ(many.report.stop, RenderStop::error);
    }
}

// Intervals too short for anything to be done between two checkpoints; times too short for a first check.
TEST(Target, ShortIntervalsAndTimesDoNotStopTheWork) {
    SceneBuilder b = mixed_scene(1, 40, 40);
    b.description.sampler.spp = 2;
    RenderState state(b.description.film);
    RenderControl control;
    int checkpoints = 0;
    control.checkpoint = [&](const RenderState&) { ++checkpoints; };
    control.checkpoint_seconds = 0;
    const auto prepared = prepared_scene(b.description);
    Renderer(b.description, {}, 0, prepared).render(state, control);
    EXPECT_EQ(state.report.samples, 2u * 1600);
    EXPECT_GT(checkpoints, 1);
    const RenderState hasty = run(b.description, {.time = 1e-6}, prepared);
    for (const Pixel& p : hasty.film.pixels()) EXPECT_GT(p.samples(), 0u);
}

// One sample of each pixel is the least, whether or not an adaptive render would like more for its pilot.
TEST(Target, TimeIsHeldFromTheFirstSampleOn) {
    SceneBuilder b = mixed_scene(1, 40, 40);
    b.description.sampler.spp = 1u << 20;
    const auto prepared = prepared_scene(b.description);
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol})
        for (const RenderTarget& target : {RenderTarget{.time = 1e-6},
                                           {.time = 1e-6, .adaptive = true},
                                           {.error = 0.01, .time = 1e-6, .adaptive = true}}) {
            b.description.sampler.kind = kind;
            const RenderState state = run(b.description, target, prepared);
            EXPECT_EQ(state.report.stop, RenderStop::time);
            for (const Pixel& p : state.film.pixels()) EXPECT_EQ(p.samples(), 1u);
        }
}

// A time limit that is not reached does not change the picture.
TEST(Target, ATimeThatIsNotUsedUpChangesNothing) {
    SceneBuilder b = mixed_scene(1, 12, 12);
    b.description.sampler.spp = 100;
    const auto prepared = prepared_scene(b.description);
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        const RenderState with = run(b.description, {.error = 1e-4, .time = 1e6, .adaptive = true}, prepared);
        const RenderState without = run(b.description, {.error = 1e-4, .adaptive = true}, prepared);
        EXPECT_EQ(with.report.samples, without.report.samples);
        for (std::size_t i = 0; i < with.film.pixels().size(); ++i) {
            const Pixel &p = with.film.pixels()[i], &q = without.film.pixels()[i];
            EXPECT_EQ(p.samples(), q.samples());
            for (int c = 0; c < 3; ++c) EXPECT_EQ(p.replicates().mean(c), q.replicates().mean(c));
        }
    }
}

// Adaptive allocation depends on the samples and must not bias the picture: the mean over many seeds equals
// that of renders with equal counts. Pixels that stop early because their first samples were dark would show
// here at once.
void expect_unbiased(const SamplerSettings& sampler, int size, std::uint64_t seeds) {
    RunningMoments adaptive, equal;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        SceneBuilder b = mixed_scene(1, size, size);
        b.description.sampler = sampler;
        b.description.sampler.seed = 1000 + seed;
        adaptive.add(picture_mean(run(b.description, {.adaptive = true}).film).mean);
        b.description.sampler.seed = 2000 + seed;
        equal.add(picture_mean(run(b.description, {}).film).mean);
    }
    const double error = std::sqrt(adaptive.variance_of_mean() + equal.variance_of_mean());
    ::testing::Test::RecordProperty("relative difference in 1e-6",
                                    static_cast<int>(1e6 * (adaptive.mean() / equal.mean() - 1)));
    ::testing::Test::RecordProperty("its error in 1e-6", static_cast<int>(1e6 * error / equal.mean()));
    EXPECT_LT(std::abs(adaptive.mean() - equal.mean()), 5 * error);
    EXPECT_LT(error, 1e-3 * equal.mean());
}

TEST(TargetSlowTest, AdaptiveIsUnbiased) { expect_unbiased({SamplerKind::independent, 0, 64}, 40, 64); }

// In the replicates that a target needs: the first errors are made of four of them. Pixels of blue noise
// lean on those around them, from which their numbers of samples come.
TEST(TargetSlowTest, AdaptiveIsUnbiasedWithSobol) {
    expect_unbiased({SamplerKind::sobol, 0, 128, 1, 8}, 56, 40);
}
TEST(TargetSlowTest, AdaptiveIsUnbiasedWithBlueNoise) {
    expect_unbiased({SamplerKind::sobol_blue_noise, 0, 128, 1, 8}, 56, 40);
}

TEST(Target, SlicesAddUpToTheWhole) {
    SceneBuilder b = mixed_scene(1, 16, 16);
    b.description.sampler.spp = 48;
    const auto prepared = prepared_scene(b.description);
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        const Film whole = render(b.description, prepared);
        std::vector<SkewMoments<3>> sums(256);
        for (std::uint32_t k = 0; k < 3; ++k) {
            const RenderState part = run(b.description, {.slice = {k, 3}}, prepared);
            for (std::size_t i = 0; i < sums.size(); ++i) sums[i].merge(part.film.pixels()[i].replicates());
        }
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const SkewMoments<3>& u = whole.pixels()[i].replicates();
            ASSERT_EQ(sums[i].count(), u.count());
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(sums[i].mean(c), u.mean(c), 1e-12 * (1 + u.mean(c)));
                EXPECT_NEAR(sums[i].standard_error(c), u.standard_error(c), 1e-9 * (1 + u.mean(c)));
            }
        }
    }
    EXPECT_THROW(Renderer(b.description, {.slice = {3, 3}}), Error);
    EXPECT_THROW(Renderer(b.description, {.slice = {48, 49}}), Error);
}

} // namespace
} // namespace montelux::testing
