#include "montelux/mc/math/incomplete_functions.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "montelux/mc/math/increasing_root.h"

namespace montelux::incomplete {
namespace {

namespace bm = boost::math;
// No exceptions in the sampling loop. `double` internally: `long double` takes four times as long.
using Policy = bm::policies::policy<bm::policies::promote_double<false>,
                                    bm::policies::domain_error<bm::policies::ignore_error>,
                                    bm::policies::pole_error<bm::policies::ignore_error>,
                                    bm::policies::overflow_error<bm::policies::ignore_error>,
                                    bm::policies::underflow_error<bm::policies::ignore_error>,
                                    bm::policies::denorm_error<bm::policies::ignore_error>,
                                    bm::policies::rounding_error<bm::policies::ignore_error>,
                                    bm::policies::evaluation_error<bm::policies::ignore_error>,
                                    bm::policies::indeterminate_result_error<bm::policies::ignore_error>>;
constexpr Policy policy;
// For results whose factors underflow although they do not.
constexpr bm::policies::normalise<Policy, bm::policies::promote_double<true>>::type extended;
constexpr double extreme = 1e-200;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Also false for NaN, which Boost's algorithms do not all survive.
bool is_probability(double p) { return p >= 0 && p <= 1; }

// I_x(1/2, 1/2), of x and 1 - x; Boost's own form of this case has an absolute error of sqrt(epsilon x).
double arcsine(double x, double y) {
    return 2 * std::numbers::inv_pi * std::atan2(std::sqrt(x), std::sqrt(y));
}

// The x <= 1/2 at which I_x(a, b), or with `complement` 1 - I_x(a, b), is `probability`. Newton on logarithms
// of both, which are nearly straight in the tail and concave elsewhere. (Boost's own inverse stops at half
// the digits in far tails and aborts in some.)
double small_beta_quantile(double a, double b, double probability, bool complement) {
    double log_probability = std::log(probability);
    auto residual = [&](double x) {
        double value = complement ? beta_complement(a, b, x) : beta(a, b, x);
        double slope = beta_pdf(a, b, x) * x / value, miss = std::log(value) - log_probability;
        return std::pair(complement ? -miss : miss, slope);
    };
    // I_x = x^a / (a B(a, b)) to first order.
    double log_beta = std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
    double below = complement ? std::log1p(-probability) : log_probability;
    constexpr double lowest = -744, highest = -std::numbers::ln2;
    double start = (below + std::log(a) + log_beta) / a;
    double log_x = increasing_root(
        lowest, highest, std::clamp(start, lowest, highest), [&](double y) { return residual(std::exp(y)); },
        1e-9);
    // The last digits, which the logarithm of a small x does not have.
    double x = std::exp(log_x);
    auto [miss, slope] = residual(x);
    double step = miss / slope;
    return std::abs(step) < 1e-6 ? x - x * step : x;
}
double beta_quantile(double a, double b, double probability, bool complement) {
    double middle = complement ? beta_complement(a, b, 0.5) : beta(a, b, 0.5);
    bool left = complement ? probability >= middle : probability <= middle;
    if (left) return small_beta_quantile(a, b, probability, complement);
    return 1 - small_beta_quantile(b, a, probability, !complement);
}

// P(T > t) far out, t^2 > 1e20 n, where the first term of the series in n / t^2 is all of it.
bool is_far(double dof, double t) { return std::abs(t) > 1e10 * std::sqrt(dof); }
double student_t_far_tail(double dof, double t) {
    return std::pow(std::sqrt(dof) / std::abs(t), dof) / (dof * bm::beta(0.5 * dof, 0.5, policy));
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
    double p = bm::ibeta(a, b, x, policy);
    return p > extreme ? p : static_cast<double>(bm::ibeta(a, b, x, extended));
}
double beta_complement(double a, double b, double x) {
    if (!(x > 0 && x < 1)) return std::isnan(x) ? nan : (x <= 0 ? 1 : 0);
    if (a == 0.5 && b == 0.5) return arcsine(1 - x, x);
    double q = bm::ibetac(a, b, x, policy);
    return q > extreme ? q : static_cast<double>(bm::ibetac(a, b, x, extended));
}
double beta_inverse(double a, double b, double p) {
    if (!is_probability(p)) return nan;
    return p == 0 || p == 1 ? p : beta_quantile(a, b, p, false);
}
double beta_complement_inverse(double a, double b, double q) {
    if (!is_probability(q)) return nan;
    return q == 0 || q == 1 ? 1 - q : beta_quantile(a, b, q, true);
}

double student_t_pdf(double dof, double t) {
    if (!std::isfinite(t)) return std::isnan(t) ? nan : 0;
    if (is_far(dof, t)) return student_t_far_tail(dof, t) * (dof / std::abs(t));
    return bm::pdf(bm::students_t_distribution<double, Policy>(dof), t);
}
double student_t_cdf(double dof, double t) {
    if (!std::isfinite(t)) return std::isnan(t) ? nan : (t < 0 ? 0 : 1);
    if (is_far(dof, t)) {
        double tail = student_t_far_tail(dof, t);
        return t < 0 ? tail : 1 - tail;
    }
    return bm::cdf(bm::students_t_distribution<double, Policy>(dof), t);
}
// By the beta law: z = n / (n + t^2) has I_z(n/2, 1/2) = 2 P(T < -|t|).
double student_t_quantile(double dof, double p) {
    if (!is_probability(p)) return nan;
    if (p == 0 || p == 1) return p == 0 ? -infinity : infinity;
    if (std::isinf(dof)) return normal_quantile(p);
    double tail = p <= 0.5 ? p : 1 - p, sign = p <= 0.5 ? -1 : 1, half = 0.5 * dof;
    if (tail == 0.5) return 0;
    double far = std::sqrt(dof) * std::exp(-std::log(tail * dof * bm::beta(half, 0.5, policy)) / dof);
    if (is_far(dof, far)) return sign * far;
    double ratio; // t^2 / n
    if (2 * tail <= beta(half, 0.5, 0.5)) {
        double z = small_beta_quantile(half, 0.5, 2 * tail, false);
        ratio = (1 - z) / z;
    } else {
        double w = tail > 0.25 ? small_beta_quantile(0.5, half, 1 - 2 * tail, false)
                               : small_beta_quantile(0.5, half, 2 * tail, true);
        ratio = w / (1 - w);
    }
    return sign * std::sqrt(dof * ratio);
}

} // namespace montelux::incomplete
