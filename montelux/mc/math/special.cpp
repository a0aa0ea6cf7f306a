#include "montelux/mc/math/special.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double tiny = 1e-300;

// Continued fractions by the modified Lentz method (Thompson and Barnett 1986): b0 + a1 / (b1 + ...).
// term(n) gives the pair (a_n, b_n), n = 1, 2, ...
template <typename Number, typename Term>
Number continued_fraction(Number b0, Term term, int max_terms) {
    Number f = std::abs(b0) > 0 ? b0 : Number(tiny), c = f, d = 0;
    for (int n = 1; n <= max_terms; ++n) {
        auto [a, b] = term(n);
        d = b + a * d;
        if (std::abs(d) < tiny) d = tiny;
        c = b + a / c;
        if (std::abs(c) < tiny) c = tiny;
        d = Number(1) / d;
        Number delta = c * d;
        f *= delta;
        if (std::abs(delta - Number(1)) < epsilon) break;
    }
    return f;
}

// x^a e^-x / Gamma(a).
double gamma_prefix(double a, double x) { return std::exp(a * std::log(x) - x - std::lgamma(a)); }

// DLMF 8.7.1: P(a, x) as a power series, for x < a + 1.
double gamma_p_series(double a, double x) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 100000 && term > sum * epsilon; ++n) {
        term *= x / (a + n);
        sum += term;
    }
    return sum * gamma_prefix(a, x);
}
// DLMF 8.9.2: Q(a, x) as a continued fraction, for x >= a + 1.
double gamma_q_fraction(double a, double x) {
    double f = continued_fraction(
        x + 1 - a, [&](int n) { return std::pair(n * (a - n), x + 2 * n + 1 - a); }, 100000);
    return gamma_prefix(a, x) / f;
}

// Increasing cdf on (lo, hi), the x with cdf(x) = p, by bisection to the last bit.
template <typename Cdf>
double bisect(double lo, double hi, double p, Cdf cdf) {
    for (int i = 0; i < 2000; ++i) {
        double mid = lo + 0.5 * (hi - lo);
        if (!(mid > lo && mid < hi)) break;
        (cdf(mid) < p ? lo : hi) = mid;
    }
    return lo + 0.5 * (hi - lo);
}

} // namespace

double normal_cdf(double x) { return 0.5 * std::erfc(-x * std::numbers::inv_sqrtpi * std::sqrt(pi / 2)); }

double normal_quantile(double p) {
    if (!(p >= 0 && p <= 1)) return nan;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (p == 0) return -infinity;
    if (p == 1) return infinity;
    // In the lower half only, where p has its digits. Newton on ln cdf, which is concave and so converges
    // from the left for any start there; near the centre the plain start is already close.
    bool upper = p > 0.5;
    double q = upper ? 1 - p : p, log_q = std::log(q);
    double x = q < 0.1 ? -std::sqrt(-2 * log_q) : (q - 0.5) * std::sqrt(2 * pi);
    for (int i = 0; i < 60; ++i) {
        double cdf = normal_cdf(x);
        double density = std::exp(-0.5 * x * x) / std::sqrt(2 * pi);
        double step = (std::log(cdf) - log_q) * cdf / density;
        x -= step;
        if (std::abs(step) <= 1e-15 * std::abs(x)) break;
    }
    return upper ? -x : x;
}

double gamma_p(double a, double x) {
    if (!(a > 0 && x >= 0)) return nan;
    if (x == 0) return 0;
    if (std::isinf(x)) return 1;
    return x < a + 1 ? gamma_p_series(a, x) : 1 - gamma_q_fraction(a, x);
}
double gamma_q(double a, double x) {
    if (!(a > 0 && x >= 0)) return nan;
    if (x == 0) return 1;
    if (std::isinf(x)) return 0;
    return x < a + 1 ? 1 - gamma_p_series(a, x) : gamma_q_fraction(a, x);
}
double chi_squared_p_value(double statistic, double dof) { return gamma_q(0.5 * dof, 0.5 * statistic); }

// DLMF 8.17.22, in the form that converges fast for x < (a + 1) / (a + b + 2).
double incomplete_beta(double a, double b, double x) {
    if (!(a > 0 && b > 0 && x >= 0 && x <= 1)) return nan;
    if (x == 0 || x == 1) return x;
    if (x > (a + 1) / (a + b + 2)) return 1 - incomplete_beta(b, a, 1 - x);
    double prefix = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) +
                             b * std::log1p(-x)) /
                    a;
    double f = continued_fraction(
        1.0,
        [&](int n) {
            int m = n / 2;
            double d = n % 2 ? -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
                             : m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
            return std::pair(d, 1.0);
        },
        100000);
    return prefix / f;
}

double student_t_cdf(double t, double dof) {
    double tail = 0.5 * incomplete_beta(0.5 * dof, 0.5, dof / (dof + t * t));
    return t < 0 ? tail : 1 - tail;
}
double student_t_quantile(double p, double dof) {
    if (!(p > 0 && p < 1 && dof > 0)) return nan;
    double q = std::min(p, 1 - p);
    if (q == 0.5) return 0;
    double hi = 1;
    while (student_t_cdf(-hi, dof) > q && hi < 1e150) hi *= 2;
    double t = bisect(-hi, 0.0, q, [&](double v) { return student_t_cdf(v, dof); });
    return p < 0.5 ? t : -t;
}

double binomial_cdf(std::int64_t k, std::int64_t n, double p) {
    if (k < 0) return 0;
    if (k >= n) return 1;
    return incomplete_beta(static_cast<double>(n - k), static_cast<double>(k + 1), 1 - p);
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

// E1(ix) = -Ci(x) + i (Si(x) - pi/2), DLMF 6.5.5, by the continued fraction DLMF 6.9.1 of E1.
std::complex<double> e1_on_imaginary_axis(double x) {
    using C = std::complex<double>;
    C z(0, x);
    C f = continued_fraction(
        z + 1.0, [&](int n) { return std::pair(C(-1.0 * n * n), z + (2.0 * n + 1)); }, 1000);
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
