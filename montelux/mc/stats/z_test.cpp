#include "montelux/mc/stats/z_test.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "montelux/mc/math/special.h"

namespace montelux {

TestResult unbiasedness_test(const RunningMoments& replicates, double truth) {
    TestResult r;
    r.degrees_of_freedom = static_cast<double>(replicates.count()) - 1;
    double error = replicates.standard_error(), miss = replicates.mean() - truth;
    // Replicates without spread are exactly right or wrong.
    r.statistic = miss == 0 ? 0 : miss / error;
    r.p_value = std::isinf(r.statistic) ? 0 : 2 * student_t_cdf(-std::abs(r.statistic), r.degrees_of_freedom);
    std::ostringstream s;
    s << "mean of " << replicates.count() << " replicates " << replicates.mean() << ", expected " << truth
      << ", t = " << r.statistic << ", p = " << r.p_value;
    r.description = s.str();
    return r;
}

TestResult unbiasedness_test(const Estimate& estimate, double truth) {
    TestResult r;
    double miss = estimate.value - truth;
    r.statistic = miss == 0 ? 0 : miss / estimate.standard_error;
    r.p_value = 2 * normal_cdf(-std::abs(r.statistic));
    std::ostringstream s;
    s << "estimate " << estimate << ", expected " << truth << ", z = " << r.statistic
      << ", p = " << r.p_value;
    r.description = s.str();
    return r;
}

TestResult calibration_test(std::span<const double> z_scores) {
    TestResult r;
    auto n = static_cast<std::int64_t>(z_scores.size());
    std::ostringstream s;
    r.p_value = 1;
    for (int k = 1; k <= 3; ++k) {
        double expected = std::erf(k / std::sqrt(2.0));
        auto within =
            std::count_if(z_scores.begin(), z_scores.end(), [&](double z) { return std::abs(z) <= k; });
        double lower = binomial_cdf(within, n, expected), upper = binomial_upper(within, n, expected);
        double p = std::min(1.0, 2 * std::min(lower, upper));
        if (3 * p < r.p_value) {
            r.p_value = 3 * p;
            r.statistic = static_cast<double>(within);
        }
        s << (k > 1 ? ", " : "") << "within " << k << ": " << within << " of " << n << " (expected "
          << expected * static_cast<double>(n) << ")";
    }
    s << ", p = " << r.p_value;
    r.description = s.str();
    return r;
}

TestResult kolmogorov_smirnov_test(std::span<const double> values, const std::function<double(double)>& cdf) {
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    TestResult r;
    double n = static_cast<double>(sorted.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        double f = cdf(sorted[i]), below = static_cast<double>(i) / n, above = static_cast<double>(i + 1) / n;
        r.statistic = std::max({r.statistic, f - below, above - f});
    }
    r.p_value = kolmogorov_p_value(r.statistic, static_cast<std::int64_t>(sorted.size()));
    std::ostringstream s;
    s << "Kolmogorov-Smirnov D = " << r.statistic << " of " << sorted.size() << " values, p = " << r.p_value;
    r.description = s.str();
    return r;
}

} // namespace montelux
