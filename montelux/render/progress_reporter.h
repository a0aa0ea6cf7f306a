// What a render tells about its progress: samples, error, and a forecast of what it still takes.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "montelux/film/film.h"
#include "montelux/render/render_control.h"
#include "montelux/render/render_state.h"
#include "montelux/render/render_target.h"
#include "montelux/render/sample_order.h"

namespace montelux {

// Of one run of a render; seconds count from its construction. Not thread-safe.
class ProgressReporter {
  public:
    ProgressReporter(const RenderTarget& target, const SampleOrder& order, const RenderState& state,
                     const RenderControl& control);

    // Seconds that this render took, earlier runs included.
    double seconds() const;
    // For reports between rounds: the last report is long enough ago.
    bool is_due() const;

    void round_begins();
    // Samples that an executor or chains took and that the state does not count yet.
    void set_samples_beyond(std::uint64_t samples) { samples_beyond_ = samples; }
    // `reached`: the error that is compared with the target's, after a round.
    void learn_from(const FilmError& error, double reached);
    // The quantile of the final film takes the place of the last round's.
    void set_final_quantile(const Film& film);

    // Calls `control.progress`. `ended`: nothing follows.
    void report(const std::optional<FilmError>& error, bool ended = false);

  private:
    using Clock = std::chrono::steady_clock;
    double run_seconds() const;

    const RenderTarget& target_;
    const SampleOrder& order_;
    const RenderState& state_;
    const RenderControl& control_;
    // What earlier runs of this render took.
    double seconds_before_;
    std::uint64_t samples_before_;
    Clock::time_point begin_ = Clock::now(), last_report_ = begin_;
    RenderProgress progress_;
    std::uint64_t samples_beyond_ = 0;
    std::uint64_t end_of_round_ = 0;                   // samples then
    std::optional<std::uint64_t> samples_for_error_{}; // that the target error takes, by the last error
};

} // namespace montelux
