#include "montelux/render/render_forecast.h"

#include <algorithm>
#include <cmath>

namespace montelux {
namespace {

double share_of(double done, double all) { return all > 0 ? std::clamp(done / all, 0.0, 1.0) : 1; }

} // namespace

std::optional<std::uint64_t> samples_for_error(double samples, double error, double target) {
    const double wanted = samples * std::pow(error / target, 2);
    if (!std::isfinite(wanted)) return std::nullopt;
    return static_cast<std::uint64_t>(std::min(wanted, 1e18));
}

std::uint64_t expected_samples(const RenderPace& pace) {
    if (!pace.samples_for_error) return pace.samples_most;
    return std::min(std::max(*pace.samples_for_error, pace.end_of_round), pace.samples_most);
}

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
        if (pace.samples_for_error) consider_samples(expected_samples(pace));
    } else {
        consider_samples(pace.samples_most);
    }
    return first.value_or(RenderForecast{});
}

} // namespace montelux
