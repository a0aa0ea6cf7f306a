#include "montelux/render/renderer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <mutex>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/render/passes.h"
#include "montelux/render/sample_context.h"

namespace montelux {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

// CPU time of the calling thread: what other programs take away does not count.
double thread_cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

constexpr int tile_size = 16;

std::vector<PixelBounds> tiles_of(const PixelBounds& crop) {
    std::vector<PixelBounds> tiles;
    for (int y = crop.y0; y < crop.y1; y += tile_size)
        for (int x = crop.x0; x < crop.x1; x += tile_size)
            tiles.push_back({x, y, std::min(x + tile_size, crop.x1), std::min(y + tile_size, crop.y1)});
    return tiles;
}

// Statistics and bad samples of the tiles that have been rendered, merged in any order: counts and minima.
struct Tally {
    std::mutex mutex;
    RenderReport report;

    void add(const RayStatistics& rays, const BadSampleReport& bad, double seconds, std::uint64_t samples) {
        std::lock_guard lock(mutex);
        report.rays.merge(rays);
        report.bad.merge(bad);
        report.cpu_seconds += seconds;
        report.samples += samples;
    }
};

} // namespace

void BadSampleReport::add(const BadSample& bad) {
    switch (bad.kind) {
    case BadSample::Kind::nan:
        ++nan;
        break;
    case BadSample::Kind::infinite:
        ++infinite;
        break;
    case BadSample::Kind::negative:
        ++negative;
        break;
    }
    auto key = [](const BadSample& b) { return std::tuple(b.sample, b.y, b.x); };
    if (!first || key(bad) < key(*first)) first = bad;
}

void BadSampleReport::merge(const BadSampleReport& other) {
    nan += other.nan;
    infinite += other.infinite;
    negative += other.negative;
    auto key = [](const BadSample& b) { return std::tuple(b.sample, b.y, b.x); };
    if (other.first && (!first || key(*other.first) < key(*first))) first = other.first;
}

Renderer::Renderer(const SceneDescription& description)
    : description_(description), sampler_(with_replicates(description.sampler)),
      camera_(description.scene.camera, description.film.width, description.film.height) {
    if (description.sampler.samples_per_pixel < 1)
        throw Error("sampler", "at least 1 sample a pixel is needed");
    auto begin = Clock::now();
    tables_ = std::make_unique<SceneTables>(description.scene);
    accelerator_ = std::make_unique<Accelerator>(description.scene, *tables_);
    build_seconds_ = seconds_since(begin);
}

RenderReport Renderer::render(Film& film, const ProgressCallback& progress, const CancelFlag* cancel) const {
    const SamplerSettings& sampler = sampler_;
    const SampleContext context(description_, sampler, *tables_, camera_);

    const std::vector<PixelBounds> tiles = tiles_of(film.bounds());
    const std::uint64_t pixels = static_cast<std::uint64_t>(film.bounds().width()) * film.bounds().height();
    RenderProgress state;
    state.samples_total = pixels * sampler.samples_per_pixel;

    Tally tally;
    auto begin = Clock::now();
    Clock::time_point last_report = begin;
    auto report_progress = [&](std::optional<FilmError> error) {
        if (!progress) return;
        state.seconds = seconds_since(begin);
        if (error) state.error = error;
        progress(state);
    };

    std::atomic<bool> stopped{false};
    std::uint64_t next_sample = 0;
    while (auto pass_found = next_pass(sampler, next_sample)) {
        const SamplePass pass = *pass_found;
        next_sample = pass.end;
        parallel_for(
            static_cast<std::int64_t>(tiles.size()),
            [&](std::int64_t t) {
                const double tile_begin = thread_cpu_seconds();
                const PixelBounds& tile = tiles[static_cast<std::size_t>(t)];
                RayTracer tracer(*accelerator_);
                BadSampleReport bad;
                std::uint64_t samples = 0;
                for (int y = tile.y0; y < tile.y1; ++y)
                    for (int x = tile.x0; x < tile.x1; ++x) {
                        // A pixel is never left in the middle of a pass.
                        if (cancel != nullptr && cancel->requested()) {
                            stopped = true;
                            break;
                        }
                        Pixel& pixel = film.pixel(x, y);
                        for (std::uint64_t i = pass.begin; i < pass.end; ++i) {
                            SampleContext::Result r = context.take(tracer, x, y, i);
                            if (r.bad) {
                                pixel.count_bad();
                                bad.add({*r.bad, x, y, i});
                            } else {
                                pixel.add_sample(r.film);
                            }
                            if (pass.every_sample_is_a_unit) pixel.end_unit();
                        }
                        if (pass.ends_unit) pixel.end_unit();
                        samples += pass.end - pass.begin;
                    }
                tally.add(tracer.statistics, bad, thread_cpu_seconds() - tile_begin, samples);
                if (progress) {
                    std::lock_guard lock(tally.mutex);
                    state.samples_done += samples;
                    if (seconds_since(last_report) > 0.2) {
                        last_report = Clock::now();
                        report_progress(std::nullopt);
                    }
                }
            },
            cancel);
        if (cancel != nullptr && cancel->requested()) stopped = true;
        if (stopped) {
            // The samples of replicates that were cut short count all the same: each is unbiased.
            film.end_units();
            tally.report.cancelled =
                next_sample < sampler.samples_per_pixel || tally.report.samples < state.samples_total;
            break;
        }
        report_progress(pass.ends_unit ? std::optional(film.error()) : std::nullopt);
    }

    RenderReport report = tally.report;
    report.seconds = seconds_since(begin);
    if (report.rays.timed > 0)
        report.ray_seconds = report.rays.timed_seconds * static_cast<double>(report.rays.rays()) /
                             static_cast<double>(report.rays.timed);
    return report;
}

} // namespace montelux
