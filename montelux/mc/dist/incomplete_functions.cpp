#include "montelux/mc/dist/incomplete_functions.h"

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace montelux::incomplete {
namespace {

namespace bm = boost::math;
// No exceptions on the way of a sample; `long double` within, which costs a third of the time and keeps the
// last digits where large numbers cancel.
using Policy = bm::policies::policy<bm::policies::domain_error<bm::policies::ignore_error>,
                                    bm::policies::pole_error<bm::policies::ignore_error>,
                                    bm::policies::overflow_error<bm::policies::ignore_error>,
                                    bm::policies::underflow_error<bm::policies::ignore_error>,
                                    bm::policies::denorm_error<bm::policies::ignore_error>,
                                    bm::policies::rounding_error<bm::policies::ignore_error>,
                                    bm::policies::evaluation_error<bm::policies::ignore_error>,
                                    bm::policies::indeterminate_result_error<bm::policies::ignore_error>>;
constexpr Policy policy;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Also false for NaN, which Boost's algorithms do not all survive.
bool is_probability(double p) { return p >= 0 && p <= 1; }

// I_x(1/2, 1/2), of x and 1 - x; Boost's own form of this case has an absolute error of sqrt(epsilon x).
double arcsine(double x, double y) {
    return 2 * std::numbers::inv_pi * std::atan2(std::sqrt(x), std::sqrt(y));
}

} // namespace

double normal_cdf(double z) { return normal_cdf_complement(-z); }
double normal_cdf_complement(double z) {
    // erfc loses 2 z^2 ulps to the rounding of its argument z / sqrt 2; the rounding error is known, and
    // its effect to first order is -density * error.
    constexpr double inv_sqrt2 = 0.5 * std::numbers::sqrt2;
    constexpr double inv_sqrt2_low = -4.8336466567264567e-17; // 1 / sqrt 2 - inv_sqrt2
    double x = z * inv_sqrt2;
    if (!(x > 1 && x < 27)) return 0.5 * std::erfc(x);
    double error = std::fma(z, inv_sqrt2, -x) + z * inv_sqrt2_low;
    return 0.5 * std::erfc(x) - error * std::exp(-x * x) * std::numbers::inv_sqrtpi;
}
double normal_quantile(double p) { return -normal_quantile_complement(p); }
double normal_quantile_complement(double q) {
    if (!is_probability(q)) return nan;
    if (q == 0) return infinity;
    if (q == 1) return -infinity;
    return std::numbers::sqrt2 * bm::erfc_inv(2 * q, policy);
}

double gamma_pdf(double a, double x) {
    if (!(x >= 0)) return 0;
    if (x == 0) return a < 1 ? infinity : (a > 1 ? 0 : 1);
    if (std::isinf(x)) return 0;
    return bm::gamma_p_derivative(a, x, policy);
}
double gamma_p(double a, double x) {
    if (!(x > 0)) return std::isnan(x) ? nan : 0;
    return std::isinf(x) ? 1 : bm::gamma_p(a, x, policy);
}
double gamma_q(double a, double x) {
    if (!(x > 0)) return std::isnan(x) ? nan : 1;
    return std::isinf(x) ? 0 : bm::gamma_q(a, x, policy);
}
double gamma_p_inverse(double a, double p) {
    if (!is_probability(p)) return nan;
    return p == 0 ? 0 : (p == 1 ? infinity : bm::gamma_p_inv(a, p, policy));
}
double gamma_q_inverse(double a, double q) {
    if (!is_probability(q)) return nan;
    return q == 0 ? infinity : (q == 1 ? 0 : bm::gamma_q_inv(a, q, policy));
}

double beta_pdf(double a, double b, double x) {
    if (!(x >= 0 && x <= 1)) return 0;
    if (x == 0) return a < 1 ? infinity : (a > 1 ? 0 : b);
    if (x == 1) return b < 1 ? infinity : (b > 1 ? 0 : a);
    return bm::ibeta_derivative(a, b, x, policy);
}
double beta(double a, double b, double x) {
    if (!(x > 0 && x < 1)) return std::isnan(x) ? nan : (x <= 0 ? 0 : 1);
    if (a == 0.5 && b == 0.5) return arcsine(x, 1 - x);
    return bm::ibeta(a, b, x, policy);
}
double beta_complement(double a, double b, double x) {
    if (!(x > 0 && x < 1)) return std::isnan(x) ? nan : (x <= 0 ? 1 : 0);
    if (a == 0.5 && b == 0.5) return arcsine(1 - x, x);
    return bm::ibetac(a, b, x, policy);
}
double beta_inverse(double a, double b, double p) {
    return is_probability(p) ? bm::ibeta_inv(a, b, p, policy) : nan;
}
double beta_complement_inverse(double a, double b, double q) {
    return is_probability(q) ? bm::ibetac_inv(a, b, q, policy) : nan;
}

double student_t_pdf(double dof, double t) {
    if (!std::isfinite(t)) return std::isnan(t) ? nan : 0;
    return bm::pdf(bm::students_t_distribution<double, Policy>(dof), t);
}
double student_t_cdf(double dof, double t) {
    if (!std::isfinite(t)) return std::isnan(t) ? nan : (t < 0 ? 0 : 1);
    return bm::cdf(bm::students_t_distribution<double, Policy>(dof), t);
}
double student_t_quantile(double dof, double p) {
    if (!is_probability(p)) return nan;
    if (p == 0 || p == 1) return p == 0 ? -infinity : infinity;
    return bm::quantile(bm::students_t_distribution<double, Policy>(dof), p);
}

} // namespace montelux::incomplete
