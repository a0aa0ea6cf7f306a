#include <cmath>
#include <cstddef>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/incomplete_functions.h"
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

TEST(Special, ChiSquaredAgainstClosedForms) {
    // Q(n, x) = e^-x sum_{k<n} x^k / k!, Q(1/2, x) = erfc(sqrt x).
    for (double x : {0.1, 1.0, 4.0, 6.5, 30.0}) {
        double sum = 0, term = 1;
        for (int k = 0; k < 5; ++k) {
            sum += term;
            term *= x / (k + 1);
        }
        EXPECT_NEAR(chi_squared_p_value(2 * x, 10) / (std::exp(-x) * sum), 1, 1e-13) << x;
        EXPECT_NEAR(chi_squared_p_value(2 * x, 1) / std::erfc(std::sqrt(x)), 1, 1e-13) << x;
    }
    // Upper 5% points of the chi-squared table.
    EXPECT_NEAR(chi_squared_p_value(3.841458820694124, 1), 0.05, 1e-14);
    EXPECT_NEAR(chi_squared_p_value(124.34211340400407, 100), 0.05, 1e-12);
}

TEST(Special, StudentTKnownPointsAndLimits) {
    EXPECT_NEAR(student_t_quantile(0.975, 5), 2.5705818356363146, 1e-12);
    // One degree of freedom is the Cauchy distribution, many are the normal one.
    EXPECT_NEAR(student_t_cdf(1, 1), 0.75, 1e-14);
    EXPECT_NEAR(student_t_quantile(0.9, 1), std::tan(0.4 * pi), 1e-11);
    EXPECT_NEAR(student_t_quantile(0.975, 1e8), 1.959963984540054, 1e-7);
}

TEST(Special, FarTailsKeepTheirDigits) {
    // Computed with 60 digits by mpmath.
    EXPECT_NEAR(normal_cdf(-37) / 5.72557122252457682e-300, 1, 1e-13);
    EXPECT_NEAR(normal_quantile(1e-300) / -37.0470962993611992, 1, 1e-15);
    EXPECT_NEAR(chi_squared_p_value(1300, 3) / 1.47174371069801034e-281, 1, 1e-13);
    EXPECT_NEAR(student_t_cdf(-1e30, 9) / 2.54589703710701741e-267, 1, 1e-13);
    EXPECT_NEAR(student_t_cdf(-20, 300) / 1.93159812815803978e-57, 1, 1e-13);
    EXPECT_NEAR(student_t_quantile(1e-300, 2) / -7.07106781186547516e+149, 1, 1e-13);
    EXPECT_NEAR(incomplete_beta(300, 1.5, 0.1) / 1.85677526758934455e-299, 1, 1e-13);
    EXPECT_NEAR(binomial_cdf(3, 1000, 0.5) / 1.55544715070148851e-293, 1, 1e-13);
    EXPECT_NEAR(binomial_upper(990, 1000, 0.5) / 2.48333879148963533e-278, 1, 1e-13);
}

TEST(Special, EndsAndArgumentsOutsideTheDomain) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(normal_cdf(-infinity), 0);
    EXPECT_EQ(normal_cdf(infinity), 1);
    EXPECT_EQ(normal_quantile(1), infinity);
    EXPECT_EQ(chi_squared_p_value(0, 3), 1);
    EXPECT_EQ(chi_squared_p_value(infinity, 3), 0);
    EXPECT_EQ(student_t_cdf(-infinity, 3), 0);
    EXPECT_EQ(student_t_cdf(infinity, 3), 1);
    EXPECT_NEAR(student_t_cdf(-1, infinity), normal_cdf(-1), 1e-15);
    EXPECT_EQ(student_t_quantile(0.1, infinity), normal_quantile(0.1));
    EXPECT_EQ(student_t_quantile(0, 3), -infinity);
    EXPECT_EQ(incomplete_beta(2, 3, 0), 0);
    EXPECT_EQ(incomplete_beta(2, 3, 1), 1);
    EXPECT_EQ(binomial_cdf(3, 10, 0), 1);
    EXPECT_EQ(binomial_cdf(3, 10, 1), 0);
    const double outside[] = {normal_cdf(nan),
                              normal_quantile(nan),
                              normal_quantile(1.5),
                              chi_squared_p_value(-1, 3),
                              chi_squared_p_value(nan, 3),
                              chi_squared_p_value(1, 0),
                              chi_squared_p_value(1, nan),
                              student_t_cdf(1, 0),
                              student_t_cdf(1, -2),
                              student_t_cdf(1, nan),
                              student_t_cdf(nan, 3),
                              student_t_quantile(0.5, 0),
                              student_t_quantile(nan, 3),
                              student_t_quantile(1.5, 3),
                              incomplete_beta(0, 1, 0.5),
                              incomplete_beta(1, -1, 0.5),
                              incomplete_beta(1, 1, 1.5),
                              incomplete_beta(1, 1, nan),
                              binomial_cdf(3, 10, -0.5),
                              binomial_upper(3, 10, nan)};
    for (std::size_t i = 0; i < std::size(outside); ++i) EXPECT_TRUE(std::isnan(outside[i])) << i;
}

// With one parameter equal to 1 the density is a power: a x^(a-1), or b (1 - x)^(b-1).
TEST(Special, BetaDensityAtItsEnds) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double c : {1.0, 1.5, 3.0, 7.0}) {
        EXPECT_EQ(incomplete::beta_pdf(c, 1, 1), c);
        EXPECT_EQ(incomplete::beta_pdf(1, c, 0), c);
        EXPECT_EQ(incomplete::beta_pdf(c, 2, 1), 0);
        EXPECT_EQ(incomplete::beta_pdf(2, c, 0), 0);
        EXPECT_EQ(incomplete::beta_pdf(c, 0.5, 1), infinity);
        EXPECT_EQ(incomplete::beta_pdf(0.5, c, 0), infinity);
        // It is continuous there.
        EXPECT_NEAR(incomplete::beta_pdf(c, 1, 1 - 1e-9), c, 1e-7);
        EXPECT_NEAR(incomplete::beta_pdf(1, c, 1e-9), c, 1e-7);
    }
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
