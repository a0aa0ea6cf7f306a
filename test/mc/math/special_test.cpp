#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/special.h"

namespace montelux {
namespace {

TEST(Special, NormalCdfAndQuantileInvertEachOther) {
    EXPECT_NEAR(normal_cdf(1.959963984540054), 0.975, 1e-15);
    EXPECT_NEAR(normal_cdf(-6), 9.865876450376981e-10, 1e-23); // tail keeps its digits
    for (double p : {1e-300, 1e-12, 0.01, 0.3, 0.5, 0.7, 0.99}) {
        double x = normal_quantile(p);
        EXPECT_NEAR(normal_cdf(x) / p, 1, 1e-12) << p;
    }
    EXPECT_TRUE(std::isinf(normal_quantile(0)));
    EXPECT_TRUE(std::isnan(normal_quantile(-0.1)));
}

TEST(Special, IncompleteGammaAgainstClosedForms) {
    // Q(n, x) = e^-x sum_{k<n} x^k / k!, P(1/2, x) = erf(sqrt x), on both sides of the switch of method.
    for (double x : {0.1, 1.0, 4.0, 6.5, 30.0}) {
        double sum = 0, term = 1;
        for (int k = 0; k < 5; ++k) {
            sum += term;
            term *= x / (k + 1);
        }
        EXPECT_NEAR(gamma_q(5, x) / (std::exp(-x) * sum), 1, 1e-12) << x;
        EXPECT_NEAR(gamma_p(0.5, x), std::erf(std::sqrt(x)), 1e-14) << x;
        EXPECT_NEAR(gamma_p(5, x) + gamma_q(5, x), 1, 1e-15);
    }
    // Upper 5% points of the chi-squared table.
    EXPECT_NEAR(chi_squared_p_value(3.841458820694124, 1), 0.05, 1e-14);
    EXPECT_NEAR(chi_squared_p_value(124.34211340400407, 100), 0.05, 1e-12);
    EXPECT_TRUE(std::isnan(gamma_p(-1, 1)));
}

TEST(Special, StudentTKnownPointsAndLimits) {
    EXPECT_NEAR(student_t_quantile(0.975, 5), 2.5705818356363146, 1e-12);
    // One degree of freedom is the Cauchy distribution, many are the normal one.
    EXPECT_NEAR(student_t_cdf(1, 1), 0.75, 1e-14);
    EXPECT_NEAR(student_t_quantile(0.9, 1), std::tan(0.4 * pi), 1e-11);
    EXPECT_NEAR(student_t_quantile(0.975, 1e8), 1.959963984540054, 1e-7);
}

TEST(Special, BinomialTailsByDirectSummation) {
    double p = 0.3, below = 0;
    int n = 12;
    for (int k = 0; k < n; ++k) {
        double upper = binomial_upper(k, n, p);
        EXPECT_NEAR(upper, 1 - below, 1e-13);
        below += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1)) * std::pow(p, k) *
                 std::pow(1 - p, n - k);
        EXPECT_NEAR(binomial_cdf(k, n, p), below, 1e-13);
    }
}

TEST(Special, KolmogorovSeriesJoinAndKnownPoint) {
    // The 5% point of the limiting law is 1.3581; with n huge the correction vanishes.
    EXPECT_NEAR(kolmogorov_p_value(1.3580986 / 1e6, 1000000000000), 0.05, 1e-6);
    std::int64_t n = 1000000000000;
    EXPECT_NEAR(kolmogorov_p_value(1.1799e-6, n), kolmogorov_p_value(1.1801e-6, n), 1e-3);
}

TEST(Special, SineAndCosineIntegrals) {
    // Abramowitz and Stegun, tables 5.1 and 5.3, and the Gibbs constant Si(pi).
    EXPECT_NEAR(sine_integral(pi), 1.8519370519824662, 1e-14);
    EXPECT_NEAR(cosine_integral(pi), 0.0736679120464255, 1e-14);
    EXPECT_NEAR(sine_integral(1), 0.9460830703671830, 1e-14);
    EXPECT_NEAR(cosine_integral(1), 0.3374039229009681, 1e-14);
    EXPECT_NEAR(sine_integral(10), 1.6583475942188740, 1e-13);
    EXPECT_NEAR(cosine_integral(10), -0.0454564330044554, 1e-13);
    // Series and continued fraction meet.
    EXPECT_NEAR(sine_integral(2 - 1e-13), sine_integral(2 + 1e-13), 1e-12);
    EXPECT_NEAR(cosine_integral(2 - 1e-13), cosine_integral(2 + 1e-13), 1e-12);
    EXPECT_EQ(sine_integral(-3), -sine_integral(3));
    EXPECT_TRUE(std::isnan(cosine_integral(-1)));
}

} // namespace
} // namespace montelux
