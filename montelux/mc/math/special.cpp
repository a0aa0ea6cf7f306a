#include "montelux/mc/math/special.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/incomplete_functions.h"

namespace montelux {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

} // namespace

double normal_cdf(double x) { return incomplete::normal_cdf(x); }
double normal_quantile(double p) { return incomplete::normal_quantile(p); }

double chi_squared_p_value(double statistic, double dof) {
    if (!(dof > 0 && statistic >= 0)) return nan;
    return incomplete::gamma_q(0.5 * dof, 0.5 * statistic);
}

double incomplete_beta(double a, double b, double x) {
    if (!(a > 0 && b > 0 && x >= 0 && x <= 1)) return nan;
    return incomplete::beta(a, b, x);
}

double student_t_cdf(double t, double dof) { return dof > 0 ? incomplete::student_t_cdf(dof, t) : nan; }
double student_t_quantile(double p, double dof) {
    return dof > 0 ? incomplete::student_t_quantile(dof, p) : nan;
}

// P(X >= k) = I_p(k, n - k + 1), DLMF 8.17.5.
double binomial_cdf(std::int64_t k, std::int64_t n, double p) {
    if (k < 0) return 0;
    if (k >= n) return 1;
    if (!(p >= 0 && p <= 1)) return nan;
    return incomplete::beta_complement(static_cast<double>(k + 1), static_cast<double>(n - k), p);
}
double binomial_upper(std::int64_t k, std::int64_t n, double p) {
    if (k <= 0) return 1;
    if (k > n) return 0;
    return incomplete_beta(static_cast<double>(k), static_cast<double>(n - k + 1), p);
}

double kolmogorov_p_value(double d, std::int64_t n) {
    // Stephens 1970, "Use of the Kolmogorov-Smirnov, Cramer-Von Mises and Related Statistics Without
    // Extensive Tables".
    double root = std::sqrt(static_cast<double>(n));
    double t = (root + 0.12 + 0.11 / root) * d;
    if (!(t > 0)) return 1;
    double p = 0;
    if (t < 1.18) {
        // Jacobi's theta identity gives the series that converges for small t.
        double y = std::exp(-pi * pi / (8 * t * t));
        return 1 - std::sqrt(2 * pi) / t * (y + std::pow(y, 9) + std::pow(y, 25) + std::pow(y, 49));
    }
    for (int j = 1; j < 100; ++j) {
        double term = std::exp(-2.0 * j * j * t * t);
        p += j % 2 ? term : -term;
        if (term < epsilon * p) break;
    }
    return std::clamp(2 * p, 0.0, 1.0);
}

namespace {

// E1(ix) = -Ci(x) + i (Si(x) - pi/2), DLMF 6.5.5, by the continued fraction DLMF 6.9.1 of E1:
// f = b0 + a1 / (b1 + ...), evaluated by the modified Lentz method (Thompson and Barnett 1986).
std::complex<double> e1_on_imaginary_axis(double x) {
    using C = std::complex<double>;
    constexpr double tiny = 1e-300;
    C z(0, x), f = z + 1.0, c = f, d = 0;
    for (int n = 1; n <= 1000; ++n) {
        C a(-1.0 * n * n), b = z + (2.0 * n + 1);
        d = b + a * d;
        if (std::abs(d) < tiny) d = tiny;
        c = b + a / c;
        if (std::abs(c) < tiny) c = tiny;
        d = 1.0 / d;
        C delta = c * d;
        f *= delta;
        if (std::abs(delta - 1.0) < epsilon) break;
    }
    return std::exp(-z) / f;
}

} // namespace

double sine_integral(double x) {
    double ax = std::abs(x);
    if (!(ax > 2)) { // DLMF 6.6.5
        double term = x, sum = x;
        for (int n = 1; n < 40; ++n) {
            term *= -x * x / ((2.0 * n) * (2.0 * n + 1));
            sum += term / (2 * n + 1);
        }
        return sum;
    }
    if (std::isinf(ax)) return std::copysign(pi / 2, x);
    return std::copysign(pi / 2 + e1_on_imaginary_axis(ax).imag(), x);
}

double cosine_integral(double x) {
    if (!(x > 0)) return nan;
    if (x <= 2) { // DLMF 6.6.6
        double term = 1, sum = euler_gamma + std::log(x);
        for (int n = 1; n < 40; ++n) {
            term *= -x * x / ((2.0 * n - 1) * (2.0 * n));
            sum += term / (2 * n);
        }
        return sum;
    }
    if (std::isinf(x)) return 0;
    return -e1_on_imaginary_axis(x).real();
}

} // namespace montelux
