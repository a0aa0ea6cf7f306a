// Renders by light paths, by chains and by guided paths have the bits of one process, however many ranks share them.
#include "test/cluster/shared_testing.h"
#include "test/render/hidden_lamp.h"
#include "test/sanitized.h"
#include <algorithm>
#include <cstdint>
#include <gtest/gtest.h>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "montelux/cluster/coordinator.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"
#include "montelux/render/renderer.h"
#include "montelux/render/splat_pass.h"

namespace montelux::testing {
namespace {

SceneDescription picture_of(IntegratorKind method, SamplerKind sampler, std::uint32_t spp) {
    SceneDescription d = mixed_scene(1, 22, 18).description;
    d.film.filter = GaussianFilter{}; // splats reach pixels of other tiles
    d.integrator.method = method;
    d.sampler.kind = sampler;
    d.sampler.spp = under_sanitizers ? spp / 3 : spp;
    return d;
}

RenderState rendered(const Renderer& renderer) {
    RenderState state(renderer.description());
    renderer.render(state);
    return state;
}

void expect_equal(const RenderState& shared, const RenderState& whole, std::string_view what) {
    EXPECT_EQ(differing(shared.film, whole.film), 0) << what;
    EXPECT_EQ(shared.report.samples, whole.report.samples) << what;
    EXPECT_EQ(shared.report.stop, whole.report.stop) << what;
    ASSERT_EQ(shared.splats.has_value(), whole.splats.has_value()) << what;
    if (!shared.splats) return;
    EXPECT_TRUE(std::ranges::equal(std::as_const(*shared.splats).sums(), std::as_const(*whole.splats).sums()))
        << what; // of an incomplete last pass
}

// Interrupted again and again after about so many samples (of as many as picture_of asks for), and resumed by another number of ranks.
RenderState interrupted(const Renderer& renderer, std::uint64_t samples, int& stops, int& within_passes) {
    RenderState state(renderer.description());
    for (bool ended = false; !ended; ++stops) {
        if (stops >= 1000) return state;
        RenderState saved = state;
        CancelFlag cancel;
        RenderControl control;
        control.cancel = &cancel;
        control.checkpoint_seconds = 0.001;
        const std::uint64_t enough = state.report.samples + (under_sanitizers ? samples / 3 : samples);
        control.checkpoint = [&](const RenderState& s) {
            saved = s;
            if (s.report.samples >= enough) cancel.request();
        };
        render_on(1 + stops % 3, renderer, state, control);
        ended = !state.report.cancelled();
        if (ended) continue;
        within_passes += saved.splats && open_samples(saved.film) > 0;
        state = saved;
    }
    return state;
}

TEST(SharedLightPaths, AnyNumberOfRanksGivesTheSameBits) {
    SceneDescription pictures[] = {picture_of(IntegratorKind::bidirectional, SamplerKind::independent, 18),
                                   picture_of(IntegratorKind::light_tracing, SamplerKind::independent, 18)};
    const std::shared_ptr<const PreparedScene> prepared[] = {Renderer(pictures[0]).prepared(),
                                                             Renderer(pictures[1]).prepared()};
    int combination = 0;
    for (const SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol})
        for (const RenderTarget& target :
             {RenderTarget{}, RenderTarget{.error = 0.3}, RenderTarget{.slice = {1, 3}}}) {
            SceneDescription& d = pictures[combination % 2];
            d.sampler.kind = sampler;
            const Renderer renderer(d, target, 0, prepared[combination % 2]);
            const RenderState whole = rendered(renderer);
            // Every number of ranks, in turns to save time.
            for (const int ranks : {2 + combination % 2, combination == 0 ? 1 : 3 - combination % 2}) {
                RenderState state(d);
                render_on(ranks, renderer, state);
                expect_equal(state, whole, "ranks");
            }
            ++combination;
        }
}

TEST(SharedLightPaths, InterruptedRendersEndWithTheSameBits) {
    for (const SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol}) {
        const SceneDescription d = picture_of(IntegratorKind::bidirectional, sampler, 40);
        const Renderer renderer(d);
        int stops = 0, within_passes = 0;
        expect_equal(interrupted(renderer, 3000, stops, within_passes), rendered(renderer), "interrupted");
        EXPECT_GE(stops, 3);
        EXPECT_TRUE(within_passes > 0 || sampler == SamplerKind::independent) << stops;
    }
}

// A rank falls silent after the third message of a kind: nothing of it counts, and a resumed render has the bits of `whole`.
RenderState resumed_without(const Renderer& renderer, protocol::Tag last, const RenderState& whole) {
    RenderState saved = render_until_lost(renderer, last, 3);
    EXPECT_LT(saved.report.samples, whole.report.samples);
    render_on(2, renderer, saved);
    expect_equal(saved, whole, "lost");
    return saved;
}

// A rank falls silent within what it sends at the end of a round: its pixels without its splats, or both without the
// end. Neither counts.
TEST(SharedLightPaths, LostRanksLeaveNoSplatsAndNoSamples) {
    const SceneDescription d = picture_of(IntegratorKind::light_tracing, SamplerKind::sobol, 64);
    const Renderer renderer(d);
    const RenderState whole = rendered(renderer);
    for (const protocol::Tag last : {protocol::tiles, protocol::splats, protocol::splat_counts})
        resumed_without(renderer, last, whole);
}

SceneDescription merging_picture(SamplerKind sampler, std::uint32_t spp) {
    SceneDescription d = picture_of(IntegratorKind::bidirectional, sampler, spp);
    d.integrator.merging = MergingSettings{.radius = 0.1f};
    return d;
}
void expect_equal_bias(const RenderState& shared, const RenderState& whole) {
    ASSERT_TRUE(shared.bias && whole.bias);
    EXPECT_EQ(shared.bias->passes(), whole.bias->passes());
    const auto same = [](const MergingBias::Cell& a, const MergingBias::Cell& b) {
        return a.sum == b.sum && a.squares == b.squares;
    };
    EXPECT_TRUE(std::ranges::equal(shared.bias->cells(), whole.bias->cells(), same));
    EXPECT_EQ(shared.report.merging.bias, whole.report.merging.bias);
    EXPECT_NE(whole.report.merging.bias, 0);
    EXPECT_EQ(shared.report.merging.last_radius, whole.report.merging.last_radius);
}

TEST(SharedMerging, AnyNumberOfRanksGivesTheSameBits) {
    SceneDescription d = merging_picture(SamplerKind::independent, 18);
    const auto prepared = Renderer(d).prepared();
    for (const SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol})
        for (const RenderTarget& target : {RenderTarget{}, RenderTarget{.error = 0.3}}) {
            d.sampler.kind = sampler;
            const Renderer renderer(d, target, 0, prepared);
            const RenderState whole = rendered(renderer);
            for (const int ranks : {1, 3}) {
                RenderState state(d);
                render_on(ranks, renderer, state);
                expect_equal(state, whole, "ranks");
                expect_equal_bias(state, whole);
            }
        }
}

TEST(SharedMerging, InterruptedRendersEndWithTheSameBits) {
    const SceneDescription d = merging_picture(SamplerKind::sobol, 40);
    const Renderer renderer(d);
    int stops = 0, within_passes = 0;
    const RenderState whole = rendered(renderer), state = interrupted(renderer, 3000, stops, within_passes);
    expect_equal(state, whole, "interrupted");
    expect_equal_bias(state, whole);
    EXPECT_GE(stops, 3);
    EXPECT_GT(within_passes, 0);
}

TEST(SharedMerging, LostRanksLeaveNoSplatsAndNoSamples) {
    const SceneDescription d = merging_picture(SamplerKind::sobol, 64);
    const Renderer renderer(d);
    const RenderState whole = rendered(renderer);
    for (const protocol::Tag last : {protocol::tiles, protocol::splat_counts, protocol::bias})
        expect_equal_bias(resumed_without(renderer, last, whole), whole);
}

TEST(SharedChains, AnyNumberOfRanksGivesTheSameBits) {
    const SceneDescription d = picture_of(IntegratorKind::metropolis, SamplerKind::independent, 48);
    const auto prepared = Renderer(d).prepared();
    for (const RenderTarget& target :
         {RenderTarget{}, RenderTarget{.error = 0.25}, RenderTarget{.slice = {1, 3}}}) {
        const Renderer renderer(d, target, 0, prepared);
        const RenderState whole = rendered(renderer);
        for (const int ranks : {2, target.error > 0 ? 3 : 1}) {
            RenderState state(d);
            render_on(ranks, renderer, state);
            expect_equal(state, whole, "ranks");
            const ChainStatistics &chains = state.report.chains, &alone = whole.report.chains;
            EXPECT_EQ(chains.groups, alone.groups);
            EXPECT_EQ(chains.large_accepted, alone.large_accepted);
            EXPECT_EQ(chains.small_accepted, alone.small_accepted);
            EXPECT_EQ(chains.starting_points, alone.starting_points);
            EXPECT_EQ(chains.longest_step, alone.longest_step);
            EXPECT_EQ(chains.agreement.worst_r_hat(), alone.agreement.worst_r_hat());
        }
    }
}

TEST(SharedChains, InterruptedRendersEndWithTheSameBits) {
    const SceneDescription d = picture_of(IntegratorKind::metropolis, SamplerKind::independent, 48);
    const Renderer renderer(d);
    int stops = 0, within_passes = 0;
    expect_equal(interrupted(renderer, 396 * 14, stops, within_passes), rendered(renderer), "interrupted");
    EXPECT_GE(stops, 3);
}

// A rank falls silent when its group is half sent, and between two groups.
TEST(SharedChains, LostRanksLeaveNoPartOfAGroup) {
    const SceneDescription d = picture_of(IntegratorKind::metropolis, SamplerKind::independent, 48);
    const Renderer renderer(d);
    const RenderState whole = rendered(renderer);
    for (const protocol::Tag last : {protocol::replicate_part, protocol::replicate}) {
        RenderState saved = render_until_lost(renderer, last, 2);
        EXPECT_LT(saved.report.samples, whole.report.samples);
        EXPECT_GT(saved.report.samples, 0u);
        render_on(2, renderer, saved);
        expect_equal(saved, whole, "lost");
        EXPECT_EQ(saved.report.chains.groups, whole.report.chains.groups);
        EXPECT_EQ(saved.report.chains.small_accepted, whole.report.chains.small_accepted);
    }
}

TEST(SharedChains, MessagesThatMakeNoSenseAreRefused) {
    const SceneDescription d = picture_of(IntegratorKind::metropolis, SamplerKind::independent, 48);
    const Renderer renderer(d);
    for (const auto& [tag, part] :
         {std::pair{protocol::replicate_part, protocol::ReplicatePart{0, 300, 200}}, // 396 pixels
          std::pair{protocol::replicate_part, protocol::ReplicatePart{0, ~std::uint64_t{0}, 2}},
          std::pair{protocol::replicate_part, protocol::ReplicatePart{3, 5, 7}}, // without its beginning
          std::pair{protocol::replicate, protocol::ReplicatePart{}},
          std::pair{protocol::done, protocol::ReplicatePart{}}}) {
        LocalJob job(2);
        ByteWriter out;
        out.put(part);
        job.mailbox(1).send(0, tag, out.take());
        Coordinator coordinator(job.mailbox(0), d.film.crop, {.threads = 1});
        RenderControl control;
        control.executor = &coordinator;
        RenderState state(d);
        EXPECT_THROW(renderer.render(state, control), Error) << tag;
    }
}

SceneDescription guided_picture(std::uint32_t spp) {
    SceneDescription d = hidden_lamp(16).description;
    d.integrator.guiding = Guiding::on;
    d.sampler.kind = SamplerKind::independent;
    d.sampler.spp = spp;
    return d;
}

TEST(SharedGuides, AnyNumberOfRanksGivesTheSameBits) {
    for (const RenderTarget& target : {RenderTarget{}, RenderTarget{.adaptive = true}}) {
        const SceneDescription d = guided_picture(96);
        const Renderer renderer(d, target);
        const RenderState whole = rendered(renderer);
        ASSERT_NE(whole.guide, nullptr);
        for (int ranks = 1; ranks <= 3; ++ranks) {
            RenderState state(d);
            render_on(ranks, renderer, state);
            expect_equal(state, whole, "ranks");
            EXPECT_EQ(state.report.guide.rounds, whole.report.guide.rounds);
            EXPECT_EQ(state.report.guide.gain, whole.report.guide.gain);
        }
    }
}

// Before and after the training; the ranks of the next job get the guide of the checkpoint.
TEST(SharedGuides, InterruptedRendersEndWithTheSameBits) {
    const SceneDescription d = guided_picture(200);
    const Renderer renderer(d);
    int stops = 0, within_passes = 0;
    expect_equal(interrupted(renderer, 10'000, stops, within_passes), rendered(renderer), "interrupted");
    EXPECT_GE(stops, 3);
}

// A rank that is ready only when the guide is trained gets it before its first tile.
TEST(SharedGuides, LateRanksGetTheGuide) {
    const SceneDescription d = guided_picture(300);
    const Renderer renderer(d);
    const RenderState whole = rendered(renderer);
    LocalJob job(2);
    SpeakingMailbox speaking(job.mailbox(1));
    std::optional<std::thread> late;
    RenderState state(d);
    Coordinator coordinator(job.mailbox(0), d.film.crop, {.tile_size = 4, .threads = 1});
    RenderControl control;
    control.executor = &coordinator;
    control.progress = [&](const RenderProgress& p) {
        if (late || p.samples_done < 2000) return;
        late.emplace([&] { serve_render(renderer, speaking, {.tile_size = 4, .threads = 1}); });
        speaking.wait();
    };
    renderer.render(state, control);
    EXPECT_EQ(coordinator.threads(), 2);
    coordinator.end();
    if (late) late->join();
    EXPECT_GT(coordinator.traffic().bytes_in, 16 * sizeof(Pixel)); // that rank has rendered a tile
    expect_equal(state, whole, "late");
}

TEST(SharedGuides, LostRanksTakeNoPart) {
    const SceneDescription d = guided_picture(96);
    const Renderer renderer(d);
    RenderState saved = render_until_lost(renderer, protocol::guide_taken, 1);
    EXPECT_NE(saved.guide, nullptr);
    render_on(2, renderer, saved);
    expect_equal(saved, rendered(renderer), "lost");
}

} // namespace
} // namespace montelux::testing
