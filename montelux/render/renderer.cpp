#include "montelux/render/renderer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <mutex>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/render/rounds.h"
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

// What the samples of a tile add beside the film.
struct TileTally {
    RayStatistics rays;
    BadSampleReport bad;
    double cpu_seconds = 0;
    std::uint64_t samples = 0, clamped_samples = 0;
};

// One run of Renderer::render.
class RenderLoop {
  public:
    RenderLoop(const Renderer& renderer, const SampleContext& context, RenderState& state,
               const RenderControl& control)
        : renderer_(renderer), context_(context), state_(state), control_(control),
          order_(renderer.sampler(), renderer.target().slice), tiles_(tiles_of(state.film.bounds())),
          seconds_before_(state.report.seconds) {}

    // The loop over rounds.
    void run() {
        for (;;) {
            if (!every_pixel_seen_)
                every_pixel_seen_ =
                    std::ranges::all_of(state_.film.pixels(), [](const Pixel& p) { return p.samples() > 0; });
            if (const auto reason = stop_between_rounds()) return end(*reason);
            if (round_is_done()) {
                std::vector<std::uint32_t> goals =
                    next_goals(state_, renderer_.sampler(), renderer_.target());
                if (goals.empty()) return end(RenderStop::samples);
                state_.goals = std::move(goals);
            }
            pause_ = false;
            parallel_for(
                static_cast<std::int64_t>(tiles_.size()),
                [&](std::int64_t t) { render_tile(tiles_[static_cast<std::size_t>(t)]); }, control_.cancel);
            state_.report.seconds = seconds();
            if (cancelled()) return end(all_taken() ? RenderStop::samples : RenderStop::cancelled);
            if (checkpoint_is_due()) save_checkpoint();
        }
    }

  private:
    double seconds() const { return seconds_before_ + seconds_since(begin_); }
    bool cancelled() const { return control_.cancel != nullptr && control_.cancel->requested(); }
    bool checkpoint_is_due() const {
        return control_.checkpoint && seconds_since(last_checkpoint_) >= control_.checkpoint_seconds;
    }
    bool out_of_time() const {
        // A picture with a sample of each pixel is the least there is to show.
        return renderer_.target().seconds > 0 && every_pixel_seen_ && seconds() >= renderer_.target().seconds;
    }
    void pause_if_due() {
        if (checkpoint_is_due() || out_of_time()) pause_ = true;
    }
    // Pixels of a restored film may lack samples of the present round, as those of a broken-off loop do.
    bool round_is_done() const {
        if (state_.goals.empty()) return true;
        const std::span<const Pixel> pixels = state_.film.pixels();
        for (std::size_t i = 0; i < pixels.size(); ++i)
            if (pixels[i].samples() < state_.goals[i]) return false;
        return true;
    }
    bool all_taken() const {
        return round_is_done() && next_goals(state_, renderer_.sampler(), renderer_.target()).empty();
    }
    bool no_unit_is_open() const {
        return std::ranges::all_of(state_.goals, [&](std::uint32_t goal) { return order_.closed(goal); });
    }

    std::optional<RenderStop> stop_between_rounds() {
        if (out_of_time()) return RenderStop::time;
        if (state_.goals.empty() || !round_is_done() || !no_unit_is_open()) return std::nullopt;
        const FilmError error = state_.film.error();
        report_progress(error);
        if (target_is_reached(error)) return RenderStop::error;
        return std::nullopt;
    }
    bool target_is_reached(const FilmError& error) const {
        const RenderTarget& target = renderer_.target();
        if (!(target.error > 0)) return false;
        // Few samples may all be dark by chance; a quantile is satisfied by pixels that saw nothing yet.
        const std::uint64_t least = target.quantile > 0 ? 4 * least_samples : least_samples;
        if (fewest_units() * order_.unit() < least) return false;
        if (!(error.mean_luminance > 0)) return error.mean_samples >= samples_of_black;
        return (target.quantile > 0 ? error_quantile(state_.film, target.quantile) : error.relative) <=
               target.error;
    }
    std::uint64_t fewest_units() const {
        std::uint64_t fewest = state_.film.pixels().front().units().count();
        for (const Pixel& p : state_.film.pixels()) fewest = std::min(fewest, p.units().count());
        return fewest;
    }

    void render_tile(const PixelBounds& tile) {
        if (pause_) return;
        const double begin = thread_cpu_seconds();
        RayTracer tracer(renderer_.accelerator());
        TileTally tally;
        const PixelBounds& film = state_.film.bounds();
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                if (pause_ || cancelled()) break;
                const auto at =
                    static_cast<std::size_t>(y - film.y0) * static_cast<std::size_t>(film.width()) +
                    static_cast<std::size_t>(x - film.x0);
                render_pixel(tracer, x, y, state_.goals[at], tally);
            }
        tally.rays = tracer.statistics;
        tally.cpu_seconds = thread_cpu_seconds() - begin;
        std::lock_guard lock(mutex_);
        RenderReport& report = state_.report;
        report.rays.merge(tally.rays);
        report.bad.merge(tally.bad);
        report.cpu_seconds += tally.cpu_seconds;
        report.samples += tally.samples;
        report.clamped_samples += tally.clamped_samples;
        // Not before something was done: short intervals must not keep the loop from going on.
        if (tally.samples > 0) pause_if_due();
        if (seconds_since(last_progress_) > 0.2) report_progress(std::nullopt);
    }

    // Samples up to the goal. A pixel that gets very many is left between two of them when the loop shall
    // stop; what it has is whole at any number of samples.
    void render_pixel(RayTracer& tracer, int x, int y, std::uint32_t goal, TileTally& tally) {
        Pixel& pixel = state_.film.pixel(x, y);
        for (std::uint64_t i = pixel.samples(); i < goal; ++i) {
            if (tally.samples % samples_between_looks == samples_between_looks - 1) {
                pause_if_due();
                if (pause_ || cancelled()) return;
            }
            const std::uint64_t index = order_.index(i);
            const SampleContext::Result r = context_.take(tracer, x, y, index);
            if (r.bad) {
                pixel.count_bad();
                tally.bad.add({*r.bad, x, y, index});
            } else {
                pixel.add_sample(r.film);
            }
            if (r.clamped != 0) {
                ++tally.clamped_samples;
                pixel.add_clamped(r.clamped);
            }
            if (order_.closed(i + 1)) pixel.end_unit();
            ++tally.samples;
        }
    }

    void report_progress(const std::optional<FilmError>& error) {
        if (!control_.progress) return;
        last_progress_ = Clock::now();
        if (error) progress_.error = error;
        progress_.seconds = seconds();
        progress_.samples_done = state_.report.samples;
        progress_.samples_total = expected_samples();
        control_.progress(progress_);
    }
    // All, or what the last error makes expect.
    std::uint64_t expected_samples() const {
        const auto pixels = static_cast<double>(state_.film.pixels().size());
        const double all = pixels * static_cast<double>(order_.share());
        const RenderTarget& target = renderer_.target();
        double expected = all;
        if (target.error > 0 && target.quantile == 0 && progress_.error)
            expected = pixels * progress_.error->mean_samples *
                       std::pow(progress_.error->relative / target.error, 2);
        if (!(expected < all)) expected = all;
        return std::max(state_.report.samples, static_cast<std::uint64_t>(expected));
    }

    void save_checkpoint() {
        control_.checkpoint(state_);
        last_checkpoint_ = Clock::now();
    }
    void end(RenderStop reason) {
        state_.report.seconds = seconds();
        state_.report.stop = reason;
        if (state_.report.rays.timed > 0)
            state_.report.ray_seconds = state_.report.rays.timed_seconds *
                                        static_cast<double>(state_.report.rays.rays()) /
                                        static_cast<double>(state_.report.rays.timed);
        if (control_.checkpoint) save_checkpoint();
        // Replicates that were cut short count where they are half of one: each is unbiased.
        state_.film.end_units(order_.unit());
        // Units that were open may have been all that was missing.
        if (reason != RenderStop::cancelled && target_is_reached(state_.film.error()))
            state_.report.stop = RenderStop::error;
    }

    static constexpr std::uint64_t samples_between_looks = 1024;
    // Of each pixel, before its error is believed; and before a picture is taken for black.
    static constexpr std::uint64_t least_samples = 16, samples_of_black = 4096;

    const Renderer& renderer_;
    const SampleContext& context_;
    RenderState& state_;
    const RenderControl& control_;
    SampleOrder order_;
    std::vector<PixelBounds> tiles_;
    double seconds_before_; // of earlier sessions
    Clock::time_point begin_ = Clock::now(), last_checkpoint_ = begin_, last_progress_ = begin_;
    bool every_pixel_seen_ = false;
    std::atomic<bool> pause_{false};
    std::mutex mutex_; // of the report and the progress
    RenderProgress progress_;
};

} // namespace

std::string_view to_string(RenderStop reason) {
    switch (reason) {
    case RenderStop::samples:
        return "samples";
    case RenderStop::error:
        return "error";
    case RenderStop::time:
        return "time";
    default:
        return "cancelled";
    }
}

Renderer::Renderer(const SceneDescription& description, const RenderTarget& target)
    : description_(description), target_(target), sampler_(with_replicates(description.sampler, target)),
      camera_(description.scene.camera, description.film.width, description.film.height) {
    if (description.sampler.samples_per_pixel < 1)
        throw Error("sampler", "at least 1 sample a pixel is needed");
    if (target.slice.index >= target.slice.count)
        throw Error("slice",
                    "slices are counted from 0, and there are " + std::to_string(target.slice.count));
    if (SampleOrder(sampler_, target.slice).share() == 0)
        throw Error("slice", "there are fewer units of samples than slices; more samples a pixel are needed");
    auto begin = Clock::now();
    tables_ = std::make_unique<SceneTables>(description.scene);
    accelerator_ = std::make_unique<Accelerator>(description.scene, *tables_);
    build_seconds_ = seconds_since(begin);
}

void Renderer::render(RenderState& state, const RenderControl& control) const {
    const SampleContext context(description_, sampler_, *tables_, camera_);
    RenderLoop(*this, context, state, control).run();
}

RenderReport Renderer::render(Film& film, const ProgressCallback& progress, const CancelFlag* cancel) const {
    RenderState state(film.settings());
    RenderControl control;
    control.progress = progress;
    control.cancel = cancel;
    render(state, control);
    film = std::move(state.film);
    return state.report;
}

} // namespace montelux
