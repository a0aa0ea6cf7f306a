// A render shared by any number of ranks, interrupted or not, ends with the bits of one process.
#include "test/cluster/shared_testing.h"
#include "test/render/mixed_scene.h"
#include "test/sanitized.h"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include "montelux/cluster/tile_worker.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"
#include "montelux/render/live_film.h"
#include "montelux/render/renderer.h"

namespace montelux::testing {
namespace {

SceneBuilder scene(SamplerKind kind, std::uint32_t spp) {
    SceneBuilder b = mixed_scene(1, 22, 18);
    b.description.sampler.kind = kind;
    b.description.sampler.spp = spp;
    return b;
}

TEST(SharedRender, AnyNumberOfRanksGivesTheSameBits) {
    int combination = 0;
    SceneBuilder b = scene(SamplerKind::independent, under_sanitizers ? 12 : 72);
    const auto prepared = Renderer(b.description).prepared();
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol})
        for (const RenderTarget& target :
             {RenderTarget{}, RenderTarget{.adaptive = true}, RenderTarget{.error = 0.2, .adaptive = true},
              RenderTarget{.error = 0.25}, RenderTarget{.slice = {1, 3}}}) {
            b.description.sampler.kind = kind;
            const Renderer renderer(b.description, target, 0, prepared);
            RenderState whole(b.description.film);
            renderer.render(whole);
            // Every number of ranks with every sampler, in turns to save time.
            for (int ranks = 1 + combination++ % 2; ranks <= 4; ranks += 2) {
                RenderState state(b.description.film);
                render_on(ranks, renderer, state);
                EXPECT_EQ(differing(whole.film, state.film), 0) << ranks << " ranks";
                EXPECT_EQ(state.report.samples, whole.report.samples);
                EXPECT_EQ(state.report.rays.rays(), whole.report.rays.rays());
                EXPECT_EQ(state.report.stop, whole.report.stop);
            }
        }
}

// The sums of layers travel with the pixels.
TEST(SharedRender, LayersHaveTheSameBits) {
    SceneBuilder b = scene(SamplerKind::sobol, 48);
    b.description.film.layers.set = {Layer::position, Layer::direct, Layer::light_groups, Layer::shape};
    const auto prepared = Renderer(b.description).prepared();
    for (const RenderTarget& target : {RenderTarget{}, RenderTarget{.error = 0.2, .adaptive = true}}) {
        const Renderer renderer(b.description, target, 0, prepared);
        RenderState whole(b.description);
        renderer.render(whole);
        ASSERT_GT(whole.film.layer_sums().size(), 0u);
        for (int ranks = 1; ranks <= 3; ++ranks) {
            RenderState state(b.description);
            render_on(ranks, renderer, state);
            EXPECT_EQ(differing(whole.film, state.film), 0);
            EXPECT_TRUE(std::ranges::equal(whole.film.layer_sums(), state.film.layer_sums())) << ranks;
        }
    }
}

// Interrupted and resumed by another number of ranks, which get the buckets with the pixels.
TEST(SharedRender, SpectralFilmsHaveTheSameBits) {
    SceneDescription d = mixed_scene(48, 22, 18).description;
    d.film.spectral = SpectralSettings{.buckets = 6};
    const Renderer renderer(d);
    RenderState whole(d);
    renderer.render(whole);
    const auto same = [](const BucketMoments& a, const BucketMoments& b) {
        return a.open == b.open && a.mean == b.mean && a.m2 == b.m2;
    };
    for (const int ranks : {1, 3}) {
        RenderState state(d);
        CancelFlag cancel;
        RenderControl control;
        control.cancel = &cancel;
        control.checkpoint_seconds = 0.001;
        control.checkpoint = [&cancel](const RenderState& s) {
            if (s.report.samples > 4000) cancel.request();
        };
        render_on(4 - ranks, renderer, state, control);
        EXPECT_TRUE(state.report.cancelled());
        render_on(ranks, renderer, state);
        EXPECT_EQ(differing(state.film, whole.film), 0) << ranks;
        EXPECT_TRUE(std::ranges::equal(std::as_const(state.film).buckets(),
                                       std::as_const(whole.film).buckets(), same))
            << ranks;
    }
    EXPECT_TRUE(std::ranges::any_of(std::as_const(whole.film).buckets(),
                                    [](const BucketMoments& b) { return b.m2 > 0; }));
}

// Interrupted after some thousand samples and resumed by another number of ranks, none of which knows the
// pixels.
TEST(SharedRender, InterruptedRendersEndWithTheSameBits) {
    const SceneBuilder b = scene(SamplerKind::independent, 100);
    const auto prepared = Renderer(b.description).prepared();
    for (bool adaptive : {false, true}) {
        const Renderer renderer(b.description, {.adaptive = adaptive}, 0, prepared);
        RenderState whole(b.description.film);
        renderer.render(whole);
        RenderState state(b.description.film);
        int stops = 0;
        for (bool ended = false; !ended; ++stops) {
            ASSERT_LT(stops, 1000);
            RenderState saved = state;
            CancelFlag cancel;
            RenderControl control;
            control.cancel = &cancel;
            control.checkpoint_seconds = 0.002;
            const std::uint64_t enough = state.report.samples + 7000;
            // The last one is that of the end, before the film is closed.
            control.checkpoint = [&](const RenderState& s) {
                saved = s;
                if (s.report.samples >= enough) cancel.request();
            };
            render_on(1 + stops % 3, renderer, state, control);
            ended = !state.report.cancelled();
            if (!ended) state = saved;
        }
        EXPECT_GE(stops, 3);
        EXPECT_EQ(differing(whole.film, state.film), 0);
        EXPECT_EQ(state.report.samples, whole.report.samples);
    }
}

// Snapshots between the rounds, and finished tiles reported as they arrive.
TEST(SharedRender, GivesSnapshots) {
    const SceneBuilder b = scene(SamplerKind::independent, 600);
    const Renderer renderer(b.description);
    RenderState whole(b.description.film), state(b.description.film);
    renderer.render(whole);
    LiveFilm live;
    std::atomic<bool> ended{false};
    std::uint64_t looks = 0, seen = 0, wrong = 0;
    std::thread watcher([&] {
        while (!ended)
            if (const auto copy = live.copy(1)) {
                std::uint64_t samples = 0;
                for (const Pixel& p : copy->film.pixels()) samples += p.samples();
                wrong += samples != copy->report.samples || samples < seen;
                seen = samples;
                ++looks;
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
            }
    });
    std::map<std::uint64_t, std::set<std::pair<int, int>>> tiles; // by round
    RenderControl control;
    control.live = &live;
    control.tile = [&](const FinishedTile& t) {
        wrong += !tiles[t.round].emplace(t.bounds.x0, t.bounds.y0).second;
    };
    render_on(3, renderer, state, control);
    ended = true;
    watcher.join();
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(looks, 2u);
    EXPECT_GT(tiles.size(), 1u);
    for (const auto& [round, corners] : tiles) EXPECT_EQ(corners.size(), 4u) << round; // 22 x 18 pixels
    EXPECT_EQ(differing(whole.film, state.film), 0);
    EXPECT_EQ(state.report.samples, whole.report.samples);
}

// A rank without tiles gets those of another, in the middle of a round.
TEST(SharedRender, TilesMoveToWhomHasNone) {
    const SceneBuilder b = scene(SamplerKind::independent, under_sanitizers ? 400 : 1500);
    const Renderer renderer(b.description);
    RenderState whole(b.description.film), state(b.description.film);
    renderer.render(whole);
    EXPECT_GT(render_on(3, renderer, state), 0u);
    EXPECT_EQ(differing(whole.film, state.film), 0);
    // Pixels that were begun anew would have the same bits.
    EXPECT_EQ(state.report.samples, whole.report.samples);
}

TEST(SharedRender, AnotherRankCanBeCancelled) {
    const SceneBuilder b = scene(SamplerKind::independent, 1u << 24);
    LocalJob job(3);
    const Renderer renderer(b.description);
    CancelFlag cancel, elsewhere;
    const Helpers helpers(job, renderer, 3, 4, &elsewhere);
    Coordinator coordinator(job.mailbox(0), b.description.film.crop, {.tile_size = 4},
                            [&] { cancel.request(); });
    RenderControl control;
    control.cancel = &cancel;
    control.executor = &coordinator;
    control.progress = [&](const RenderProgress& p) {
        if (p.samples_done > 10'000) elsewhere.request();
    };
    RenderState state(b.description.film);
    renderer.render(state, control);
    EXPECT_TRUE(state.report.cancelled());
    std::uint64_t samples = 0;
    for (const Pixel& p : state.film.pixels()) samples += p.samples();
    EXPECT_EQ(samples, state.report.samples);
    EXPECT_GT(samples, 10'000u);
}

// A rank falls silent after its first message: the render ends with the work of the others, and resumes to
// the bits of an undisturbed one.
TEST(SharedRender, SilentRanksAreGivenUp) {
    const SceneBuilder b = scene(SamplerKind::independent, 400);
    const Renderer renderer(b.description);
    RenderState whole(b.description.film), state(b.description.film), saved(b.description.film);
    renderer.render(whole);
    {
        LocalJob job(2);
        ByteWriter hello;
        hello.put(std::int32_t{2});
        job.mailbox(1).send(0, protocol::hello, hello.take());
        Coordinator coordinator(job.mailbox(0), b.description.film.crop,
                                {.tile_size = 4, .threads = 1, .patience_seconds = 0.3});
        RenderControl control;
        control.executor = &coordinator;
        control.checkpoint = [&](const RenderState& s) { saved = s; };
        renderer.render(state, control);
        EXPECT_TRUE(coordinator.failed());
        EXPECT_NE(coordinator.failure()->find("rank 1 has not answered"), std::string::npos);
        EXPECT_TRUE(state.report.cancelled());
        EXPECT_GT(saved.report.samples, 0u);
        EXPECT_LT(saved.report.samples, whole.report.samples);
    }
    render_on(2, renderer, saved);
    EXPECT_EQ(differing(whole.film, saved.film), 0);
    EXPECT_EQ(saved.report.samples, whole.report.samples);
}

TEST(SharedRender, MessagesThatMakeNoSenseAreRefused) {
    const SceneBuilder b = scene(SamplerKind::independent, 4);
    LocalJob job(2);
    const Renderer renderer(b.description);
    renderer.serve([&](const SampleTakers& takers) {
        TileWorker worker(takers.tiles, tiles_of(b.description.film.crop, 4), 1, job.mailbox(1));
        ByteWriter out;
        out.put(std::uint32_t{3});
        const std::vector<std::uint8_t> bytes = out.take();
        EXPECT_THROW(worker.handle({0, protocol::release, bytes}), Error); // it holds no tile
        EXPECT_THROW(worker.handle({0, 99, bytes}), Error);
        EXPECT_THROW(worker.handle({0, protocol::assign, bytes}), Error); // cut short
    });
}

} // namespace
} // namespace montelux::testing
