#include "montelux/render/progress_reporter.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "montelux/render/render_forecast.h"
#include "montelux/render/sample_allocation.h"

namespace montelux {

ProgressReporter::ProgressReporter(const RenderTarget& target, const SampleOrder& order,
                                   const RenderState& state, const RenderControl& control)
    : target_(target), order_(order), state_(state), control_(control), seconds_before_(state.report.seconds),
      samples_before_(state.report.samples) {}

double ProgressReporter::run_seconds() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
}

double ProgressReporter::seconds() const { return seconds_before_ + run_seconds(); }

bool ProgressReporter::is_due() const {
    return std::chrono::duration<double>(Clock::now() - last_report_).count() > 0.2;
}

void ProgressReporter::round_begins() {
    const std::span<const Pixel> pixels = state_.film.pixels();
    end_of_round_ = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        end_of_round_ += std::max<std::uint64_t>(pixels[i].samples(), state_.target_samples[i]);
}

void ProgressReporter::learn_from(const FilmError& error, double reached) {
    if (target_.quantile > 0) progress_.quantile = {target_.quantile, reached};
    const double samples = static_cast<double>(state_.film.pixels().size()) * error.mean_samples;
    samples_for_error_ = samples_for_error(samples, reached, target_.error);
}

void ProgressReporter::set_final_quantile(const Film& film) {
    if (progress_.quantile) progress_.quantile = {target_.quantile, error_quantile(film, target_.quantile)};
}

void ProgressReporter::report(const std::optional<FilmError>& error, bool ended) {
    if (!control_.progress) return;
    last_report_ = Clock::now();
    if (error) progress_.error = error;
    progress_.seconds = seconds();
    progress_.samples_done = state_.report.samples + samples_beyond_;
    const RenderPace pace{.samples_done = progress_.samples_done,
                          .samples_most = state_.film.pixels().size() * order_.share(),
                          .samples_for_error = samples_for_error_,
                          .end_of_round = end_of_round_,
                          .seconds = progress_.seconds,
                          .run_samples = progress_.samples_done - samples_before_,
                          .run_seconds = run_seconds()};
    progress_.samples_total =
        std::max(progress_.samples_done, std::min(pace.samples_most, expected_samples(pace)));
    const bool complete = ended && state_.report.stop != RenderStop::cancelled;
    const double share_before = progress_.forecast.share;
    progress_.forecast = complete ? RenderForecast{1, 0} : forecast(pace, target_);
    // A new estimate of what is left never takes back what was shown.
    progress_.forecast.share = std::max(progress_.forecast.share, share_before);
    progress_.ended = ended;
    control_.progress(progress_);
}

} // namespace montelux
