#include "montelux/render/render_forecast.h"

#include <algorithm>

namespace montelux {
namespace {

double share_of(double done, double all) { return all > 0 ? std::clamp(done / all, 0.0, 1.0) : 1; }

} // namespace

RenderForecast forecast(const RenderPace& pace, const RenderTarget& target) {
    const auto done = static_cast<double>(pace.samples_done);
    if (pace.samples_done >= pace.samples_most) return {1, 0};
    std::optional<RenderForecast> first;
    const auto consider = [&](double share, double seconds_left) {
        if (!first || seconds_left < *first->seconds_left)
            first = RenderForecast{share, std::max(seconds_left, 0.0)};
    };
    if (target.time > 0) consider(share_of(pace.seconds, target.time), target.time - pace.seconds);
    const double speed = pace.run_seconds > 0 ? static_cast<double>(pace.run_samples) / pace.run_seconds : 0;
    const auto consider_samples = [&](std::uint64_t all) {
        const auto n = static_cast<double>(all);
        if (speed > 0) consider(share_of(done, n), (n - done) / speed);
    };
    if (target.error > 0) {
        if (pace.samples_for_error) consider_samples(std::min(*pace.samples_for_error, pace.samples_most));
    } else {
        consider_samples(pace.samples_most);
    }
    return first.value_or(RenderForecast{});
}

} // namespace montelux
