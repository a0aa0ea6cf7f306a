// render_forecast: how far a render is on its way to its first limit, and how long that still takes.
#pragma once

#include <cstdint>
#include <optional>

#include "montelux/render/render_target.h"

namespace montelux {

// A running render.
struct RenderPace {
    std::uint64_t samples_done = 0;
    std::uint64_t samples_most = 0;                   // all that may be taken
    std::optional<std::uint64_t> samples_for_error{}; // that the target error takes, once it is estimated
    std::uint64_t end_of_round = 0;                   // the samples after which the error is looked at next
    double seconds = 0;                               // of all runs of this render
    // Of this run alone, after a resumption: they give the speed.
    std::uint64_t run_samples = 0;
    double run_seconds = 0;
};

struct RenderForecast {
    double share = 0; // of the way, from 0 to 1
    std::optional<double> seconds_left{};
};

// The samples that an error takes, from the error after some samples: it falls with the root of their number.
std::optional<std::uint64_t> samples_for_error(double samples, double error, double target);

// That the target error takes, to the end of a round; all that may be taken while it is not known.
std::uint64_t expected_samples(const RenderPace& pace);

// The limit that is met first decides: the target's time, its error, or the number of samples. As long as the error
// cannot be estimated, it might be met long before the last sample: then a limit of time alone gives a forecast.
RenderForecast forecast(const RenderPace& pace, const RenderTarget& target);

} // namespace montelux
