// Drives integrators without a stopping rule to a relative error.
#pragma once

#include "bench/integrate/method.h"
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace montelux::bench {

struct Trial {
    double value = 0, error = 0;
    bool warned = false;
};

// Factor on the evaluations while the error is too large.
struct Growth {
    double least = 2, most = 16; // prediction by 1/sqrt(N) with a fifth in reserve, within these factors

    static Growth by(double factor) { return {factor, factor}; }
};

// Runs trial(N) with N from `first` upwards until its claimed error is small enough, or until the cap, which
// counts all trials, makes that impossible. trial(N) makes at most about N evaluations. A request without a
// target is one trial with all of them.
template <typename RunTrial>
Answer escalate(const CountedIntegrand& f, const Request& request, std::uint64_t first, const Growth& growth,
                const RunTrial& trial) {
    Answer answer;
    auto run = [&](std::uint64_t n) {
        const Trial result = trial(n);
        answer.value = result.value;
        answer.error = result.error;
        answer.warned = result.warned;
        answer.converged =
            request.relative_error > 0 && result.error <= request.relative_error * std::abs(result.value);
    };
    if (!(request.relative_error > 0)) {
        run(request.evaluations);
        return answer;
    }
    std::uint64_t n = first;
    while (f.evaluations() + n <= request.evaluations) {
        run(n);
        if (answer.converged) break;
        const double ratio = answer.error / (request.relative_error * std::abs(answer.value));
        const double wanted = 1.2 * ratio * ratio * static_cast<double>(n);
        const double left = static_cast<double>(request.evaluations) - static_cast<double>(f.evaluations());
        double next = std::isfinite(wanted) ? wanted : 1e300;
        next = std::clamp(next, growth.least * static_cast<double>(n), growth.most * static_cast<double>(n));
        // A last trial that takes what is left, where that may be enough.
        if (next > left && wanted < 2 * left && growth.most > growth.least) next = left;
        if (next > left || (wanted > 50 * left && growth.most > growth.least)) break;
        n = static_cast<std::uint64_t>(next);
    }
    return answer;
}

} // namespace montelux::bench
