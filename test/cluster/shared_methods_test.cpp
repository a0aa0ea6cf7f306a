// Renders by light paths and by chains have the bits of one process, however many ranks share them.
#include "test/cluster/shared_testing.h"
#include "test/sanitized.h"
#include <algorithm>
#include <cstdint>
#include <gtest/gtest.h>
#include <optional>
#include <string_view>
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

RenderState rendered(const SceneDescription& d, const RenderTarget& target = {}) {
    RenderState state(d);
    Renderer(d, target).render(state);
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

// Interrupted again and again after about so many samples, and resumed by another number of ranks.
RenderState interrupted(const SceneDescription& d, std::uint64_t samples, int& stops, int& within_passes) {
    RenderState state(d);
    for (bool ended = false; !ended; ++stops) {
        if (stops >= 1000) return state;
        RenderState saved = state;
        CancelFlag cancel;
        RenderControl control;
        control.cancel = &cancel;
        control.checkpoint_seconds = 0.001;
        const std::uint64_t enough = state.report.samples + samples;
        control.checkpoint = [&](const RenderState& s) {
            saved = s;
            if (s.report.samples >= enough) cancel.request();
        };
        render_on(1 + stops % 3, d, {}, state, control);
        ended = !state.report.cancelled();
        if (ended) continue;
        within_passes += saved.splats && open_samples(saved.film) > 0;
        state = saved;
    }
    return state;
}

TEST(SharedLightPaths, AnyNumberOfRanksGivesTheSameBits) {
    int combination = 0;
    for (const SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol})
        for (const RenderTarget& target :
             {RenderTarget{}, RenderTarget{.error = 0.3}, RenderTarget{.slice = {1, 3}}}) {
            const SceneDescription d = picture_of(combination % 2 == 0 ? IntegratorKind::bidirectional
                                                                       : IntegratorKind::light_tracing,
                                                  sampler, 18);
            const RenderState whole = rendered(d, target);
            // Every number of ranks, in turns to save time.
            for (const int ranks : {2 + combination % 2, combination == 0 ? 1 : 3 - combination % 2}) {
                RenderState state(d);
                render_on(ranks, d, target, state);
                expect_equal(state, whole, "ranks");
            }
            ++combination;
        }
}

TEST(SharedLightPaths, InterruptedRendersEndWithTheSameBits) {
    for (const SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol}) {
        const SceneDescription d = picture_of(IntegratorKind::bidirectional, sampler, 40);
        int stops = 0, within_passes = 0;
        expect_equal(interrupted(d, 3000, stops, within_passes), rendered(d), "interrupted");
        EXPECT_GE(stops, 3);
        EXPECT_TRUE(within_passes > 0 || sampler == SamplerKind::independent) << stops;
    }
}

// A rank falls silent within what it sends at the end of a round: its pixels without its splats, or both without the
// end. Neither counts.
TEST(SharedLightPaths, LostRanksLeaveNoSplatsAndNoSamples) {
    const SceneDescription d = picture_of(IntegratorKind::light_tracing, SamplerKind::sobol, 64);
    const RenderState whole = rendered(d);
    for (const protocol::Tag last : {protocol::tiles, protocol::splats, protocol::splat_counts}) {
        RenderState saved = render_until_lost(d, last, 3);
        EXPECT_LT(saved.report.samples, whole.report.samples);
        render_on(2, d, {}, saved);
        expect_equal(saved, whole, "lost");
    }
}

TEST(SharedChains, AnyNumberOfRanksGivesTheSameBits) {
    for (const RenderTarget& target :
         {RenderTarget{}, RenderTarget{.error = 0.25}, RenderTarget{.slice = {1, 3}}}) {
        const SceneDescription d = picture_of(IntegratorKind::metropolis, SamplerKind::independent, 48);
        const RenderState whole = rendered(d, target);
        for (const int ranks : {2, target.error > 0 ? 3 : 1}) {
            RenderState state(d);
            render_on(ranks, d, target, state);
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
    int stops = 0, within_passes = 0;
    expect_equal(interrupted(d, 396 * 14, stops, within_passes), rendered(d), "interrupted");
    EXPECT_GE(stops, 3);
}

// A rank falls silent when its group is half sent, and between two groups.
TEST(SharedChains, LostRanksLeaveNoPartOfAGroup) {
    const SceneDescription d = picture_of(IntegratorKind::metropolis, SamplerKind::independent, 48);
    const RenderState whole = rendered(d);
    for (const protocol::Tag last : {protocol::replicate_part, protocol::replicate}) {
        RenderState saved = render_until_lost(d, last, 2);
        EXPECT_LT(saved.report.samples, whole.report.samples);
        EXPECT_GT(saved.report.samples, 0u);
        render_on(2, d, {}, saved);
        expect_equal(saved, whole, "lost");
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

} // namespace
} // namespace montelux::testing
