// Result of a statistical test, and thresholds for many tests together.
#pragma once

#include <cmath>
#include <string>

namespace montelux {

struct TestResult {
    double statistic = 0;
    double degrees_of_freedom = 0; // 0 where the statistic has none
    double p_value = 0;            // probability of a result this bad from correct code
    std::string description;

    // Rejects correct code with probability `level` at most. NaN does not pass.
    bool passes(double level) const { return p_value > level; }
};

// The threshold for each of `tests` independent tests when all together may raise a false alarm with
// probability `level`. Sidak 1967, "Rectangular Confidence Regions for the Means of Multivariate
// Normal Distributions".
inline double sidak_threshold(double level, int tests) { return -std::expm1(std::log1p(-level) / tests); }

} // namespace montelux
