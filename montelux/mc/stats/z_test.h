// Tests of estimators: unbiasedness, calibration of the error, and Kolmogorov-Smirnov.
#pragma once

#include <functional>
#include <span>

#include "montelux/mc/stats/estimate.h"
#include "montelux/mc/stats/test_result.h"

namespace montelux {

// Is the mean of independent replicates the truth? Two-sided Student t-test.
TestResult unbiasedness_test(const RunningMoments& replicates, double truth);
// Is the truth where this estimate says it is? Two-sided, by the normal law.
TestResult unbiasedness_test(const Estimate& estimate, double truth);

// Are claimed standard errors honest? Given (value - truth) / standard_error of many independent
// estimates, counts how many lie within 1, 2 and 3 and compares with the normal law by two-sided binomial
// tests, Bonferroni over the three. Too small and too large errors are both rejected.
TestResult calibration_test(std::span<const double> z_scores);

// Do the values follow this continuous distribution? Two-sided Kolmogorov-Smirnov.
TestResult kolmogorov_smirnov_test(std::span<const double> values, const std::function<double(double)>& cdf);

} // namespace montelux
