// RenderSession: resuming, snapshots, finished tiles, denoising.
#include "test/render/mixed_scene.h"
#include "test/temporary_folder.h"
#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <tuple>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/render_session.h"
#include "montelux/render/render_warnings.h"
#include "montelux/render/sample_context.h"
#include "montelux/render/tile_renderer.h"

namespace montelux::testing {
namespace {

std::shared_ptr<const SceneDescription> described(SamplerKind kind, std::uint32_t spp, int width = 40,
                                                  int height = 24) {
    SceneBuilder b = mixed_scene(1, width, height);
    b.description.film.crop = {3, 2, width, height};
    b.description.sampler.kind = kind;
    b.description.sampler.spp = spp;
    return std::make_shared<SceneDescription>(b.description);
}

// Bits of all layers.
bool same_image(const Image& a, const Image& b) {
    const auto x = a.f32(), y = b.f32();
    return a.channel_names() == b.channel_names() && x.size() == y.size() &&
           std::memcmp(x.data(), y.data(), x.size_bytes()) == 0;
}

// Without what differs between any two renders.
Attributes header_of(const Image& image) {
    Attributes attributes = image.attributes();
    attributes.erase("renderSeconds");
    return attributes;
}

TEST(FinishedTiles, EachIsReportedOncePerRound) {
    const auto d = described(SamplerKind::independent, 100);
    const auto prepared = prepared_scene(*d);
    for (const bool adaptive : {false, true})
        for (const double checkpoint_seconds : {1e9, 0.001, 0.0}) {
            // Pauses for checkpoints cut tiles short, which are finished later in the round, or leave them
            // out, even those that lack no samples in this round. With 0 seconds each batch ends in a pause;
            // one thread then meets such a tile in every run of the test.
            const ThreadLimit threads(checkpoint_seconds > 0 ? 0 : 1);
            const Renderer renderer(*d, {.adaptive = adaptive}, 0, prepared);
            RenderState state(d->film);
            std::mutex mutex;
            std::map<std::uint64_t, std::map<std::pair<int, int>, int>> calls; // of rounds and tiles
            std::map<std::pair<int, int>, std::vector<Pixel>> last;
            int wrong = 0, checkpoints = 0;
            RenderControl control;
            control.checkpoint_seconds = checkpoint_seconds;
            control.checkpoint = [&](const RenderState&) { ++checkpoints; };
            control.tile = [&](const FinishedTile& tile) {
                std::vector<Pixel> pixels;
                for (int y = tile.bounds.y0; y < tile.bounds.y1; ++y)
                    for (int x = tile.bounds.x0; x < tile.bounds.x1; ++x)
                        pixels.push_back(tile.film->pixel(x, y));
                const std::lock_guard lock(mutex);
                wrong += tile.film != &state.film;
                ++calls[tile.round][{tile.bounds.x0, tile.bounds.y0}];
                auto& before = last[{tile.bounds.x0, tile.bounds.y0}];
                for (std::size_t i = 0; i < before.size(); ++i)
                    wrong += pixels[i].samples() < before[i].samples();
                before = std::move(pixels);
            };
            renderer.render(state, control);
            EXPECT_EQ(wrong, 0);
            EXPECT_GT(calls.size(), 3u);
            EXPECT_EQ(calls.begin()->first, 0u);
            EXPECT_EQ(calls.rbegin()->first, calls.size() - 1);
            for (const auto& [round, tiles] : calls) {
                EXPECT_EQ(tiles.size(), 6u) << round; // 37 x 22 pixels, 16 x 16 each
                for (const auto& [corner, count] : tiles) EXPECT_EQ(count, 1) << round;
            }
            if (checkpoint_seconds < 1) {
                EXPECT_GT(checkpoints, 3);
            }
            // What was given in the last round is the film.
            int differing = 0;
            for (const PixelBounds& b : tiles_of(d->film.crop, 16)) {
                std::size_t i = 0;
                const std::vector<Pixel>& pixels = last.at({b.x0, b.y0});
                for (int y = b.y0; y < b.y1; ++y)
                    for (int x = b.x0; x < b.x1; ++x)
                        differing += !same_pixel(pixels[i++], state.film.pixel(x, y));
            }
            EXPECT_EQ(differing, 0);
        }
}

// A resumed render reports the tiles that its interrupted round had finished as well.
TEST(FinishedTiles, AreReportedAfterAResumeInTheMiddleOfARound) {
    const auto d = described(SamplerKind::independent, 64);
    const Renderer renderer(*d);
    RenderState state(d->film);
    CancelFlag cancel;
    RenderControl control;
    control.cancel = &cancel;
    std::atomic<int> tiles{0};
    control.tile = [&](const FinishedTile& tile) {
        if (tile.round == 3 && ++tiles == 3) cancel.request();
    };
    renderer.render(state, control);
    ASSERT_TRUE(state.report.cancelled());
    std::mutex mutex;
    std::map<std::uint64_t, int> calls;
    RenderControl resumed;
    resumed.tile = [&](const FinishedTile& tile) {
        const std::lock_guard lock(mutex);
        ++calls[tile.round];
    };
    renderer.render(state, resumed);
    ASSERT_GT(calls.size(), 1u);
    EXPECT_EQ(calls.begin()->first, 0u);
    for (const auto& [round, count] : calls) EXPECT_EQ(count, 6) << round;
}

// Samples that a stopped tile left out belong to that tile only.
TEST(Tiles, StoppedOnesKeepNoSamplesForTheNext) {
    const auto d = described(SamplerKind::independent, 4);
    const Renderer renderer(*d);
    const SampleContext context(*d, renderer.sampler(), renderer.scene(), renderer.camera());
    const TileRenderer tiles(context, renderer.accelerator(), SampleOrder(renderer.sampler(), {}));
    const std::vector<std::uint32_t> targets(16, 4);
    struct Tile {
        std::vector<Pixel> pixels = std::vector<Pixel>(16);
        TileTally tally;
    };
    const auto take = [&](Tile& tile, int x0, int pixels_before_stop) {
        const TileView view{.bounds = {x0, 4, x0 + 4, 8},
                            .pixels = tile.pixels.data(),
                            .stride = 4,
                            .target_samples = targets.data(),
                            .target_stride = 4};
        tiles.render(
            view, tile.tally, [&] { return pixels_before_stop-- == 0; }, [] { return false; });
    };
    Tile stopped, next, again;
    take(stopped, 8, 5);
    take(next, 12, -1);
    EXPECT_EQ(stopped.tally.samples, 0u); // less than a batch
    for (const Pixel& p : stopped.pixels) EXPECT_EQ(p.samples(), 0u);
    EXPECT_EQ(next.tally.samples, 64u);
    for (const Pixel& p : next.pixels) EXPECT_EQ(p.samples(), 4u);
    take(stopped, 8, -1);
    take(again, 8, -1);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_TRUE(same_pixel(stopped.pixels[i], again.pixels[i]));
}

TEST(Snapshots, ChangeNoBitAndAreBetweenSamples) {
    SceneDescription all = *described(SamplerKind::independent, 48);
    all.film.spectral = SpectralSettings{.lambda_min = 400, .lambda_max = 700, .buckets = 2};
    all.film.layers.set.add(Layer::position);
    const auto d = std::make_shared<const SceneDescription>(all);
    const auto prepared = prepared_scene(*d);
    RenderSession plain(d, {.prepared = prepared}), watched(d, {.prepared = prepared});
    plain.render();
    const RenderSnapshot whole = plain.finish();

    std::vector<RenderSnapshot> seen;
    std::atomic<bool> ended{false};
    watched.prepare();
    EXPECT_FALSE(watched.snapshot(0)); // it has not begun
    std::thread watcher([&] {
        while (!ended)
            if (auto s = watched.snapshot(1)) seen.push_back(std::move(*s));
    });
    with_threads(4, [&] { watched.render(); });
    ended = true;
    watcher.join();
    EXPECT_FALSE(watched.snapshot(1));
    const RenderSnapshot result = watched.finish();
    EXPECT_TRUE(same_image(*result.image, *whole.image));
    EXPECT_EQ(header_of(*result.image), header_of(*whole.image));
    ASSERT_GT(seen.size(), 5u);

    // A pixel of a snapshot equals that of a render with this number of samples.
    std::map<int, Image> renders;
    auto rendered = [&](int spp) -> const Image& {
        const auto known = renders.find(spp);
        if (known != renders.end()) return known->second;
        SceneDescription of_spp = *d;
        of_spp.sampler.spp = static_cast<std::uint32_t>(std::max(spp, 1));
        RenderState state(of_spp);
        if (spp > 0) Renderer(of_spp, {}, 0, prepared).render(state);
        return renders.emplace(spp, state.film.develop()).first->second;
    };
    const auto channel = [&](const char* name) { return *whole.image->find_channel(name); };
    const int samples = channel("samples");
    const int compared_channels[] = {channel("R"), channel("stderr.G"), channel("P.X"),
                                     channel("S0.475,000nm")};
    double before = 0;
    int differing = 0, compared = 0;
    for (std::size_t k = 0; k < seen.size(); k += std::max<std::size_t>(1, seen.size() / 20)) {
        const Image& image = *seen[k].image;
        EXPECT_GE(seen[k].error.mean_samples, before);
        before = seen[k].error.mean_samples;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const Image& same = rendered(static_cast<int>(image.value(x, y, samples)));
                differing += std::ranges::any_of(
                    compared_channels, [&](int c) { return image.value(x, y, c) != same.value(x, y, c); });
                ++compared;
            }
    }
    EXPECT_EQ(differing, 0) << "of " << compared;
}

// Concurrent snapshots each get a copy; one that does not wait gets none or a complete one.
TEST(Snapshots, ManyThreadsAtOnce) {
    const auto d = described(SamplerKind::sobol, 200);
    RenderSession session(d, {});
    session.prepare();
    std::atomic<bool> ended{false};
    std::atomic<int> copies{0}, sizes_wrong{0};
    std::vector<std::thread> watchers;
    for (int i = 0; i < 4; ++i)
        watchers.emplace_back([&, patience = i == 0 ? 0.0 : 1.0] {
            while (!ended)
                if (const auto s = session.snapshot(patience)) {
                    ++copies;
                    sizes_wrong += s->image->width() != 37 || s->image->height() != 22;
                }
        });
    session.render();
    ended = true;
    for (std::thread& t : watchers) t.join();
    EXPECT_GT(copies, 3);
    EXPECT_EQ(sizes_wrong, 0);
}

class Sessions : public ::testing::Test {
  protected:
    TemporaryFolder folder_;
};

TEST_F(Sessions, ResumeToTheSameBits) {
    const auto scene = described(SamplerKind::independent, 64);
    const auto prepared = prepared_scene(*scene);
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        const auto d = described(kind, 64);
        RenderSession plain(d, {.prepared = prepared});
        plain.render();
        const RenderSnapshot whole = plain.finish();
        EXPECT_FALSE(plain.resumed());

        const std::filesystem::path path = folder_ / ("render" + std::to_string(int(kind)));
        CancelFlag cancel;
        RenderSession first(d, {.target = {}, .scene_name = {}, .checkpoint = path, .prepared = prepared});
        std::atomic<int> tiles{0};
        first.render({.tile =
                          [&](const FinishedTile&) {
                              if (++tiles == 20) cancel.request();
                          },
                      .cancel = &cancel});
        const RenderSnapshot interrupted = first.finish();
        EXPECT_TRUE(interrupted.report.cancelled());
        EXPECT_EQ(first.checkpoint_failure(), "");

        EXPECT_THROW(RenderSession(d, {.target = {}, .scene_name = {}, .checkpoint = path}), Error);
        RenderSession second(d, {.target = {}, .scene_name = {}, .checkpoint = path, .resume = true});
        EXPECT_TRUE(second.resumed());
        EXPECT_EQ(second.refused_checkpoint(), "");
        EXPECT_GT(second.samples_before(), 0);
        EXPECT_LT(second.samples_before(), 64);
        second.render();
        const RenderSnapshot result = second.finish();
        EXPECT_TRUE(same_image(*result.image, *whole.image)) << int(kind);
        EXPECT_EQ(header_of(*result.image), header_of(*whole.image)) << int(kind);
    }
}

TEST_F(Sessions, SettingsThatMakeNoSenseAreRefused) {
    const auto d = described(SamplerKind::independent, 4);
    EXPECT_THROW(RenderSession(d, {.target = {}, .scene_name = {}, .checkpoint = {}, .resume = true}), Error);
    RenderSession slice(d, {.target = {.slice = {7, 5}}, .scene_name = {}, .checkpoint = {}});
    EXPECT_THROW(slice.prepare(), Error);
}

// The render continues, and reports it.
TEST_F(Sessions, CheckpointsThatFailCostNothingElse) {
    const auto d = described(SamplerKind::independent, 16);
    RenderSession plain(d, {}),
        failing(d, {.target = {}, .scene_name = {}, .checkpoint = folder_ / "none/render.state"});
    plain.render();
    int failures = 0;
    failing.render({.checkpoint_failed = [&](const std::string& reason) { failures += !reason.empty(); }});
    EXPECT_GT(failures, 0);
    EXPECT_NE(failing.checkpoint_failure(), "");
    EXPECT_TRUE(same_image(*failing.finish().image, *plain.finish().image));
}

TEST_F(Sessions, DenoisingIsForFinishedRenders) {
    const auto d = described(SamplerKind::independent, 8);
    auto add_layer = [](Image& image) {
        image.append(Image(image.width(), image.height(), {"Y"}), "denoised.");
    };
    RenderSession session(d, {});
    session.render();
    const RenderSnapshot denoised = session.finish(add_layer);
    EXPECT_TRUE(denoised.image->find_channel("denoised.Y"));
    EXPECT_EQ(denoised.denoise_failure, "");
    ASSERT_TRUE(denoised.outliers);
    EXPECT_EQ(denoised.outliers->pixels, 37u * 22u);

    RenderSession broken(d, {});
    broken.render();
    const RenderSnapshot kept = broken.finish([](Image&) { throw Error("the denoiser is out of order"); });
    EXPECT_EQ(kept.denoise_failure, "the denoiser is out of order");
    EXPECT_FALSE(kept.image->find_channel("denoised.Y"));

    RenderSession stopped(described(SamplerKind::independent, 1u << 20), {});
    CancelFlag cancel;
    stopped.render({.tile = [&](const FinishedTile&) { cancel.request(); }, .cancel = &cancel});
    EXPECT_FALSE(stopped.finish(add_layer).image->find_channel("denoised.Y"));
}

TEST_F(Sessions, WarningsSayWhatIsMissing) {
    BadSampleReport bad;
    EXPECT_EQ(bad_sample_warning(bad, 3), "");
    bad.add({BadSample::Kind::infinite, 4, 5, 6});
    bad.add({BadSample::Kind::nan, 1, 2, 7});
    EXPECT_EQ(
        bad_sample_warning(bad, 3),
        "2 samples were left out (1 not a number, 1 infinite, 0 negative); the first, infinite, is sample 6 "
        "of pixel 4,5 with seed 3");
    const auto d = described(SamplerKind::sobol, 1u << 16);
    CancelFlag cancel;
    RenderSession stopped(d, {});
    stopped.render({.tile =
                        [&](const FinishedTile& tile) {
                            if (tile.round == 2) cancel.request();
                        },
                    .cancel = &cancel});
    const RenderSnapshot result = stopped.finish();
    EXPECT_NE(missing_error_warning(result, stopped.renderer()).find("fewer than two replicates of 4096"),
              std::string::npos);
    RenderSession whole(described(SamplerKind::sobol, 16), {});
    whole.render();
    const RenderSnapshot complete = whole.finish();
    EXPECT_EQ(missing_error_warning(complete, whole.renderer()), "");
}

} // namespace
} // namespace montelux::testing
