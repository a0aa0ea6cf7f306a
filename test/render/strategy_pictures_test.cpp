// The pictures of the strategies of bidirectional path tracing, and the walks of chains: they are those of the render.
#include "test/render/mixed_scene.h"
#include "test/render/seed_means.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/metropolis/chain_renderer.h"
#include "montelux/render/strategy_pictures.h"

namespace montelux::testing {
namespace {

// Colours, glass, lamps and an environment, with a filter that is wider than a pixel, and a part of the film.
SceneDescription strategies_scene(SamplerKind kind = SamplerKind::independent) {
    SceneDescription d = mixed_scene().description;
    d.integrator.method = IntegratorKind::bidirectional;
    d.integrator.max_depth = 5;
    d.film.filter = GaussianFilter{};
    d.film.crop = {3, 2, 16, 14};
    d.sampler.kind = kind;
    d.sampler.spp = 32;
    return d;
}

TEST(StrategyPictures, SumToTheRender) {
    for (const IntegratorKind method : {IntegratorKind::bidirectional, IntegratorKind::light_tracing}) {
        SceneDescription of_method = strategies_scene();
        of_method.integrator.method = method;
        const auto prepared = prepared_scene(of_method);
        for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
            SceneDescription d = strategies_scene(kind);
            d.integrator.method = method;
            const Renderer renderer(d, {}, 0, prepared);
            RenderState state(d);
            renderer.render(state);
            const std::vector<StrategyPicture> pictures = strategy_pictures(renderer);
            // All but the lamp joined to the lens, s = 1 and t = 1; those of light tracing with s = 0 for two vertices.
            EXPECT_EQ(pictures.size(), method == IntegratorKind::bidirectional ? 26u : 6u);
            for (std::size_t p = 0; p < state.film.pixels().size(); ++p) {
                Vec3d sum;
                for (const StrategyPicture& picture : pictures) sum += Vec3d(picture.weighted[p]);
                for (int c = 0; c < 3; ++c) {
                    const double value = state.film.pixels()[p].replicates().mean(c);
                    EXPECT_NEAR(sum[c], value, 2e-5 * value + 1e-7) << p << ' ' << c << ' ' << int(kind);
                }
            }
        }
    }
}

TEST(StrategyPictures, ThreadsDoNotMatter) {
    const SceneDescription d = strategies_scene();
    const auto on = [&](int threads) {
        return with_threads(threads, [&] { return strategy_pictures(Renderer(d)); });
    };
    const std::vector<StrategyPicture> one = on(1), three = on(3);
    ASSERT_EQ(one.size(), three.size());
    for (std::size_t i = 0; i < one.size(); ++i)
        for (std::size_t p = 0; p < one[i].weighted.size(); ++p) {
            EXPECT_EQ(one[i].weighted[p], three[i].weighted[p]);
            EXPECT_EQ(one[i].unweighted[p], three[i].unweighted[p]);
        }
}

// Paths lamp, floor, camera: all strategies that find three vertices expect the same light.
TEST(StrategyPictures, EachAloneExpectsTheSameLight) {
    SceneBuilder b = lit_corner();
    add_box_lamp(b, 0.8);
    SceneDescription& d = b.description;
    d.integrator.method = IntegratorKind::bidirectional;
    d.integrator.max_depth = 1;
    d.sampler.spp = 64;
    std::array<RunningMoments, 3> of;
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        d.sampler.seed = seed;
        for (const StrategyPicture& picture : strategy_pictures(Renderer(d))) {
            if (picture.s + picture.t != 3) continue;
            double sum = 0;
            for (const Vec3f& pixel : picture.unweighted) sum += double(pixel.y);
            of[picture.s].add(sum);
        }
    }
    for (const std::size_t s : {std::size_t{0}, std::size_t{2}}) {
        ASSERT_EQ(of[s].count(), 24u);
        EXPECT_NEAR(of[s].mean(), of[1].mean(),
                    7 * std::hypot(of[s].standard_error(), of[1].standard_error()))
            << s;
        EXPECT_LT(of[s].standard_error(), 0.05 * of[s].mean()) << s;
    }
}

void expect_refused(const SceneDescription& d, const std::string& reason) {
    try {
        strategy_pictures(Renderer(d));
        ADD_FAILURE() << reason;
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find(reason), std::string::npos) << e.what();
    }
}

TEST(StrategyPictures, RefusesWhatHasNone) {
    SceneDescription d = lit_corner().description;
    d.integrator.method = IntegratorKind::bidirectional;
    d.integrator.max_depth = most_strategy_depth + 1;
    expect_refused(d, "max_depth is 13; expected at most 12");
    d.integrator.max_depth = 5;
    SceneDescription large = d;
    large.film.width = large.film.height = 8192;
    large.film.crop = {0, 0, 8192, 8192};
    expect_refused(large, "they would take 122 GiB");
    d.integrator.merging = MergingSettings{};
    expect_refused(d, "merging");
    d.integrator.merging.reset();
    d.integrator.method = IntegratorKind::path;
    expect_refused(d, "the integrator 'path' has none");
    d.integrator.method = IntegratorKind::bidirectional;
    EXPECT_TRUE(strategy_pictures(Renderer(d), [] { return true; }).empty());
}

std::vector<ChainWalk> traces_of(const SceneDescription& d, std::size_t chains, ChainReplicate* replicate,
                                 std::shared_ptr<const PreparedScene> prepared = nullptr) {
    std::vector<ChainWalk> traces;
    Renderer(d, {}, 0, std::move(prepared)).serve([&](const SampleTakers& takers) {
        const GroupWatch watch{[] { return false; }, [](std::uint64_t) {}};
        traces = takers.chains->trace(2, chains, watch);
        if (replicate != nullptr) *replicate = std::move(takers.chains->take(2, 1, watch).front());
    });
    return traces;
}

TEST(ChainWalks, AreTheWalksOfTheRender) {
    SceneBuilder b = lit_corner();
    add_box_lamp(b);
    SceneDescription& d = b.description;
    d.integrator.method = IntegratorKind::metropolis;
    d.integrator.max_depth = 2;
    d.sampler.spp = 151000; // of which a group has a 32nd: bundles of more than one chain
    ChainReplicate replicate;
    const auto prepared = prepared_scene(d);
    const std::vector<ChainWalk> all = traces_of(d, 1000, &replicate, prepared);
    const ChainStatistics& s = replicate.tally.statistics;
    ASSERT_EQ(all.size(), s.chains);
    ASSERT_EQ(s.chains, 32u);
    std::uint64_t large = 0, small = 0, off = 0;
    double large_accepted = 0, small_accepted = 0;
    for (const ChainWalk& trace : all) {
        ASSERT_EQ(trace.steps.size(), s.states);
        double size = trace.start_size;
        for (const ChainWalk::Step& step : trace.steps) {
            (step.large ? large : small) += 1;
            (step.large ? large_accepted : small_accepted) += step.acceptance;
            off += !(std::abs(step.acceptance - std::min(1.0, step.size / size)) < 1e-9);
            if (step.accepted) size = step.size;
        }
    }
    EXPECT_EQ(off, 0u);
    EXPECT_EQ(large, s.large_steps);
    EXPECT_EQ(small, s.small_steps);
    EXPECT_NEAR(large_accepted, s.large_accepted, 1e-9 * s.large_accepted);
    EXPECT_NEAR(small_accepted, s.small_accepted, 1e-9 * s.small_accepted);
    // The first ones are the same alone.
    const std::vector<ChainWalk> few = traces_of(d, 2, nullptr, prepared);
    ASSERT_EQ(few.size(), 2u);
    for (std::size_t c = 0; c < few.size(); ++c)
        for (std::size_t t = 0; t < few[c].steps.size(); ++t)
            EXPECT_EQ(few[c].steps[t].proposed, all[c].steps[t].proposed);
}

TEST(ChainWalks, WithoutLightThereAreNone) {
    SceneBuilder b = lit_corner();
    SceneDescription d = b.description;
    d.integrator.method = IntegratorKind::metropolis;
    d.integrator.max_depth = 1; // a short pilot
    d.sampler.spp = 64;
    EXPECT_TRUE(traces_of(d, 4, nullptr).empty());
}

} // namespace
} // namespace montelux::testing
