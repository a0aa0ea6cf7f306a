// Special functions: normal, chi-squared, Student and binomial distributions; sine and cosine integrals.
#pragma once

#include <cstdint>

namespace montelux {

// Euler's constant.
inline constexpr double euler_gamma = 0.57721566490153286060651209008240243;

// Distribution functions for tests and error bars, as accurate as incomplete_functions.h. They return NaN
// outside their domains and never throw.
// P(X <= x) of the standard normal distribution.
double normal_cdf(double x);
// The x with normal_cdf(x) = p; p in (0, 1), the ends give +-infinity.
double normal_quantile(double p);
// P(X >= statistic) of the chi-squared distribution.
double chi_squared_p_value(double statistic, double degrees_of_freedom);
// Regularised incomplete beta function I_x(a, b), a, b > 0, x in [0, 1].
double incomplete_beta(double a, double b, double x);
double student_t_cdf(double t, double degrees_of_freedom);
// The t with student_t_cdf(t, dof) = p; p in (0, 1), the ends give +-infinity.
double student_t_quantile(double p, double degrees_of_freedom);
// P(X <= k) and P(X >= k) for a binomial variable of n trials.
double binomial_cdf(std::int64_t k, std::int64_t n, double p);
double binomial_upper(std::int64_t k, std::int64_t n, double p);
// P(D >= d) for Kolmogorov's two-sided statistic of n values, by the asymptotic law with Stephens'
// correction for finite n.
double kolmogorov_p_value(double d, std::int64_t n);

// Si(x) = integral of sin t / t from 0 to x; Ci(x) = gamma + ln x + integral of (cos t - 1) / t from 0 to x,
// x > 0 (NaN otherwise). Absolute error below 1e-14.
double sine_integral(double x);
double cosine_integral(double x);

} // namespace montelux
