#include "montelux/render/render_loop.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/guide_training.h"
#include "montelux/render/live_film.h"
#include "montelux/render/merging_passes.h"
#include "montelux/render/progress_reporter.h"
#include "montelux/render/round_executor.h"
#include "montelux/render/sample_allocation.h"
#include "montelux/render/splat_pass.h"
#include "montelux/render/stopping_rule.h"
#include "montelux/render/tile_renderer.h"

namespace montelux {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

constexpr int tile_size = 16;

// One run of Renderer::render.
class RenderLoop {
  public:
    // `chains`: take the samples; null: tiles do.
    RenderLoop(const Renderer& renderer, SampleContext& context, ChainRenderer* chains, RenderState& state,
               const RenderControl& control)
        : renderer_(renderer), context_(context), state_(state), control_(control),
          order_(renderer.sampler(), renderer.target().slice),
          tile_renderer_(context, renderer.accelerator(), order_), chains_(chains),
          tiles_(tiles_of(state.film.bounds(), tile_size)), finished_(tiles_.size()) {
        if (context.merges())
            passes_.emplace(context, renderer.accelerator(), *renderer.description().integrator.merging,
                            state.film.bounds());
        if (!round_is_done()) { // in a restored state
            round_ = 0;
            progress_.round_begins();
        }
        context_.set_guide(state_.guide);
        if (control.live != nullptr) control.live->open(state, tiles_, [this] { return report_now(); });
    }
    ~RenderLoop() {
        close_live();
        if (control_.executor != nullptr) control_.executor->release();
    }
    RenderLoop(const RenderLoop&) = delete;
    RenderLoop& operator=(const RenderLoop&) = delete;

    // The loop over rounds.
    void run() {
        for (;;) {
            if (!every_pixel_seen_)
                every_pixel_seen_ = std::ranges::all_of(state_.film.pixels(), [this](const Pixel& p) {
                    return state_.splats ? p.replicates().count() > 0 : p.samples() > 0;
                });
            // Before the next round is chosen: a resumed render trains its guide first, too.
            if (!train_guide_if_due()) return end(all_taken() ? RenderStop::samples : RenderStop::cancelled);
            if (const auto reason = stop_between_rounds()) return end(*reason);
            if (round_is_done()) {
                std::vector<std::uint32_t> target_samples =
                    next_target_samples(state_, renderer_.sampler(), renderer_.target());
                if (target_samples.empty()) return end(RenderStop::samples);
                state_.target_samples = std::move(target_samples);
                if (control_.executor != nullptr && every_pixel_seen_)
                    join_rounds(state_, order_, renderer_.target());
                progress_.round_begins();
                std::ranges::fill(finished_, char{0});
                ++round_;
            }
            take_samples();
            if (state_.splats && round_is_done() && no_replicate_is_open()) close_pass();
            {
                std::lock_guard lock(mutex_);
                state_.report.seconds = progress_.seconds();
            }
            if (cancelled() || (control_.executor != nullptr && control_.executor->failed()))
                return end(all_taken() ? RenderStop::samples : RenderStop::cancelled);
            if (checkpoint_is_due()) save_checkpoint();
        }
    }

  private:
    bool cancelled() const { return control_.cancel != nullptr && control_.cancel->requested(); }
    bool checkpoint_is_due() const {
        return control_.checkpoint && seconds_since(last_checkpoint_) >= control_.checkpoint_seconds;
    }
    bool out_of_time() const {
        // A time limit ends the render only after one sample per pixel, or two groups of chains.
        const bool may_end = chains_ != nullptr ? errors_are_known_ : every_pixel_seen_;
        return renderer_.target().time > 0 && may_end && progress_.seconds() >= renderer_.target().time;
    }
    bool pause_is_due() const { return checkpoint_is_due() || out_of_time(); }
    void pause_if_due() {
        if (pause_is_due()) pause_ = true;
    }
    // Pixels of a restored film may lack samples of the current round, as after an interrupted loop.
    bool round_is_done() const {
        if (state_.target_samples.empty()) return true;
        const std::span<const Pixel> pixels = state_.film.pixels();
        for (std::size_t i = 0; i < pixels.size(); ++i)
            if (pixels[i].samples() < state_.target_samples[i]) return false;
        return true;
    }
    bool all_taken() const {
        return round_is_done() &&
               next_target_samples(state_, renderer_.sampler(), renderer_.target()).empty();
    }
    bool no_replicate_is_open() const {
        return std::ranges::all_of(state_.target_samples,
                                   [&](std::uint32_t target) { return order_.closed(target); });
    }

    std::optional<RenderStop> stop_between_rounds() {
        if (out_of_time()) return RenderStop::time;
        if (state_.target_samples.empty() || !round_is_done() || !no_replicate_is_open()) return std::nullopt;
        const FilmError error = state_.film.error();
        if (const auto reached = stopping_.error_for_target(state_.film, error))
            progress_.learn_from(error, *reached);
        progress_.report(error);
        if (stopping_.is_reached(state_.film, error)) return RenderStop::error;
        return std::nullopt;
    }
    // After a first sample of every pixel: a render that is cancelled early has a picture. False: it was cancelled.
    bool train_guide_if_due() {
        const IntegratorSettings& settings = renderer_.description().integrator;
        if (settings.guiding == Guiding::off || state_.report.guide.decided || !every_pixel_seen_ ||
            !round_is_done())
            return true;
        if (cancelled()) return false;
        const RenderTarget& target = renderer_.target();
        const GuideTrainingPlan plan{.bounds = state_.film.bounds(),
                                     .samples = order_.share(),
                                     .error = target.quantile > 0 ? 0 : target.error,
                                     .seconds = target.time,
                                     .cancel = control_.cancel};
        TrainedGuide trained =
            train_guide(context_, renderer_.accelerator(), settings, plan, control_.executor);
        state_.guide = std::move(trained.guide);
        std::lock_guard lock(mutex_);
        state_.report.guide = trained.summary;
        state_.report.cpu_seconds += trained.summary.cpu_seconds;
        state_.report.seconds = progress_.seconds();
        return trained.summary.decided;
    }

    void take_samples() {
        if (chains_ != nullptr) return take_groups();
        if (control_.executor != nullptr) return let_executor_take_samples();
        pause_ = false;
        if (passes_) return take_merging_passes();
        render_tiles(state_.target_samples);
    }

    void render_tiles(std::span<const std::uint32_t> target_samples) {
        parallel_for(
            static_cast<std::int64_t>(tiles_.size()),
            [&](std::int64_t t) { render_tile(static_cast<std::size_t>(t), target_samples); },
            control_.cancel);
    }

    std::uint32_t fewest_samples() const {
        const std::span<const Pixel> pixels = state_.film.pixels();
        return std::ranges::min_element(pixels, {}, &Pixel::samples)->samples();
    }
    // Sample by sample: those of one index merge.
    void take_merging_passes() {
        for (std::uint32_t n = fewest_samples(); n < state_.target_samples.front() && !pause_; ++n) {
            passes_->prepare(order_.index(n), state_.report, mutex_, control_.cancel);
            if (cancelled()) return;
            render_tiles(std::vector<std::uint32_t>(state_.target_samples.size(), n + 1));
        }
    }

    // The splats of a pass become part of its replicates.
    void close_pass() {
        SplatFilm& splats = *state_.splats;
        check_sums(splats);
        const std::uint64_t samples = open_samples(state_.film);
        if (samples == 0) return; // closed before the render was interrupted
        LiveFilm* const live = control_.live;
        parallel_for(static_cast<std::int64_t>(tiles_.size()), [&](std::int64_t i) {
            const auto t = static_cast<std::size_t>(i);
            const PixelBounds& tile = tiles_[t];
            const auto held = live != nullptr ? live->hold(t) : std::unique_lock<std::mutex>();
            add_splats(state_.film, splats, tile, samples);
            state_.film.end_replicates(tile);
        });
        splats.clear();
        if (state_.bias) {
            std::lock_guard lock(mutex_);
            close_bias(state_, samples);
        }
        for (std::size_t t = 0; t < tiles_.size(); ++t) report_if_finished(t);
    }

    // The same, of several processes: each makes the light map of an index for itself.
    void share_merging_passes(const RoundWatch& watch) {
        const std::vector<std::uint32_t> targets = state_.target_samples;
        for (std::uint32_t n = fewest_samples(); n < targets.front(); ++n) {
            const auto prepare = [&] {
                passes_->prepare(order_.index(n), state_.report, mutex_, control_.cancel);
            };
            control_.executor->meanwhile(prepare, [] {});
            if (cancelled()) break;
            std::ranges::fill(state_.target_samples, n + 1);
            control_.executor->run(tile_renderer_, state_, watch);
            if (!round_is_done() || control_.executor->failed() || watch.stop(true)) break;
        }
        state_.target_samples = targets;
    }

    void let_executor_take_samples() {
        LiveFilm* const live = control_.live;
        const RoundWatch watch{[&](bool something_done) {
                                   const bool copy_wanted = live != nullptr && live->is_wanted();
                                   return cancelled() || (something_done && (pause_is_due() || copy_wanted));
                               },
                               [this](std::uint64_t samples, const std::optional<FilmError>& error) {
                                   progress_.set_samples_beyond(samples);
                                   progress_.report(error);
                               },
                               control_.cancel};
        {
            const auto held = live != nullptr ? live->hold_all() : std::unique_lock<std::timed_mutex>();
            if (passes_)
                share_merging_passes(watch);
            else
                control_.executor->run(tile_renderer_, state_, watch);
        }
        progress_.set_samples_beyond(0);
        for (std::size_t t = 0; t < tiles_.size() && !state_.splats; ++t) report_if_finished(t);
        if (live != nullptr) live->wait_for_copies();
    }

    void take_groups() {
        LiveFilm* const live = control_.live;
        const auto tell = [this](std::uint64_t paths) {
            std::lock_guard lock(mutex_);
            progress_.set_samples_beyond(paths);
            if (progress_.is_due()) progress_.report(std::nullopt);
        };
        const auto add = [&](const std::function<void()>& change) {
            const auto held = live != nullptr ? live->hold_all() : std::unique_lock<std::timed_mutex>();
            std::lock_guard lock(mutex_);
            change();
            progress_.set_samples_beyond(0);
        };
        const ChainWatch watch{
            {[this] { return cancelled() || out_of_time(); }, tell}, [this] { return pause_is_due(); }, add};
        if (control_.executor != nullptr)
            control_.executor->run(*chains_, state_, state_.target_samples.front(), watch);
        else
            chains_->run(state_, state_.target_samples.front(), watch);
        errors_are_known_ = state_.film.pixels().front().replicates().count() >= 2;
        for (std::size_t t = 0; t < tiles_.size(); ++t) report_if_finished(t);
    }

    void render_tile(std::size_t index, std::span<const std::uint32_t> target_samples) {
        // A tile may have its samples of this round before any are taken: then the round may end in this pause.
        if (pause_) return state_.splats ? void() : report_if_finished(index);
        const PixelBounds& film = state_.film.bounds();
        const PixelBounds& tile = tiles_[index];
        const auto stride = static_cast<std::size_t>(film.width());
        const std::size_t first = static_cast<std::size_t>(tile.y0 - film.y0) * stride +
                                  static_cast<std::size_t>(tile.x0 - film.x0);
        TileTally tally;
        LiveFilm* const live = control_.live;
        auto stopped = [&] {
            if (live != nullptr) live->between_samples(index);
            return pause_ || cancelled();
        };
        {
            const auto held = live != nullptr ? live->hold(index) : std::unique_lock<std::mutex>();
            tile_renderer_.render(
                {.bounds = tile,
                 .pixels = &state_.film.pixels()[first],
                 .stride = stride,
                 .buckets = buckets_at(first),
                 .bucket_count = state_.film.buckets_per_pixel(),
                 .target_samples = &target_samples[first],
                 .target_stride = stride,
                 .layer_sums = state_.film.layer_sums().data() + first * state_.film.layers().sums(),
                 .splats = state_.splats ? &*state_.splats : nullptr,
                 .bias = state_.bias ? &*state_.bias : nullptr},
                tally, stopped, [&] {
                    pause_if_due();
                    return stopped();
                });
        }
        if (!state_.splats) report_if_finished(index); // otherwise after the pass
        std::lock_guard lock(mutex_);
        tally.add_to(state_.report);
        // Only after some samples: short intervals must not stop progress.
        if (tally.samples > 0) pause_if_due();
        if (progress_.is_due()) progress_.report(std::nullopt);
    }

    BucketMoments* buckets_at(std::size_t pixel) {
        const std::size_t n = state_.film.buckets_per_pixel();
        return n > 0 ? &state_.film.buckets()[pixel * n] : nullptr;
    }

    void report_if_finished(std::size_t index) {
        if (!control_.tile || finished_[index] != 0) return;
        const PixelBounds& film = state_.film.bounds();
        const PixelBounds& tile = tiles_[index];
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const std::size_t i =
                    static_cast<std::size_t>(y - film.y0) * static_cast<std::size_t>(film.width()) +
                    static_cast<std::size_t>(x - film.x0);
                if (state_.film.pixels()[i].samples() < state_.target_samples[i]) return;
            }
        finished_[index] = 1;
        control_.tile({tile, round_, &state_.film});
    }

    RenderReport report_now() {
        std::lock_guard lock(mutex_);
        RenderReport report = state_.report;
        report.seconds = progress_.seconds();
        return report;
    }
    void close_live() {
        if (control_.live != nullptr) control_.live->close();
    }

    void save_checkpoint() {
        control_.checkpoint(state_);
        last_checkpoint_ = Clock::now();
    }
    void end(RenderStop reason) {
        close_live();
        state_.report.seconds = progress_.seconds();
        state_.report.stop = reason;
        if (state_.report.rays.timed > 0)
            state_.report.ray_seconds = state_.report.rays.timed_seconds *
                                        static_cast<double>(state_.report.rays.rays()) /
                                        static_cast<double>(state_.report.rays.timed);
        if (control_.checkpoint) save_checkpoint();
        // The last replicate of what is left open is closed in a copy.
        std::optional<Film> copy;
        if (control_.keep_open && (reason == RenderStop::cancelled || reason == RenderStop::time))
            copy = state_.film;
        Film& film = copy ? *copy : state_.film;
        // Truncated replicates count if they are at least half of one: each is unbiased.
        if (state_.splats)
            end_pass(film, *state_.splats, order_.replicate_size());
        else
            film.end_replicates(order_.replicate_size());
        const FilmError error = film.error();
        // The open replicates may have been the only ones missing.
        if (reason != RenderStop::cancelled && stopping_.is_reached(film, error))
            state_.report.stop = RenderStop::error;
        progress_.set_final_quantile(film);
        progress_.report(std::isfinite(error.relative) ? std::optional(error) : std::nullopt, true);
    }

    const Renderer& renderer_;
    SampleContext& context_;
    RenderState& state_;
    const RenderControl& control_;
    SampleOrder order_;
    StoppingRule stopping_{renderer_.target(), order_.replicate_size()};
    TileRenderer tile_renderer_;
    ChainRenderer* chains_;
    std::optional<MergingPasses> passes_; // where paths merge
    std::vector<PixelBounds> tiles_;
    std::vector<char> finished_;              // of each tile, in this round
    std::uint64_t round_ = ~std::uint64_t{0}; // incremented to 0 by the first round
    Clock::time_point last_checkpoint_ = Clock::now();
    bool every_pixel_seen_ = false;
    bool errors_are_known_ = state_.film.pixels().front().replicates().count() >= 2;
    std::atomic<bool> pause_{false};
    std::mutex mutex_; // of the report and the progress
    ProgressReporter progress_{renderer_.target(), order_, state_, control_};
};

} // namespace

void run_render_loop(const Renderer& renderer, SampleContext& context, ChainRenderer* chains,
                     RenderState& state, const RenderControl& control) {
    RenderLoop(renderer, context, chains, state, control).run();
}

} // namespace montelux
