// Judging families of statistics: conjugate models, orthants, order statistics, products of uniform variables.
#include "bench/hard/judging.h"
#include <algorithm>
#include <array>
#include <boost/math/special_functions/zeta.hpp>

#include "montelux/mc/math/special.h"

namespace montelux::bench {

namespace {

// x^k (1 - x)^m over [0, 1], or x^k exp(-m x) over the half-line, over its largest value.
struct Likelihood {
    bool binomial;
    double k, m;

    double logarithm(double x) const { return k * std::log(x) + (binomial ? m * std::log1p(-x) : -m * x); }
    double most() const { return logarithm(binomial ? k / (k + m) : k / m); }
    double integral() const {
        const double log_integral = binomial
                                        ? std::lgamma(k + 1) + std::lgamma(m + 1) - std::lgamma(k + m + 2)
                                        : std::lgamma(k + 1) - (k + 1) * std::log(m);
        return std::exp(log_integral - most());
    }
};

HardIntegral conjugate(Draws& draws) {
    const int n = draws.integer(1, 5);
    const bool binomial = draws.chance(0.5);
    std::vector<Likelihood> groups;
    double exact = 1, offset = 0;
    for (int j = 0; j < n; ++j) {
        // A prior of powers 0.1..2, or of shape 1.1..3.
        const double first = draws.uniform(0.1, 2), second = draws.uniform(0.1, 2);
        if (binomial) {
            const double trials = std::round(draws.log_uniform(5, 3000));
            const double hits = std::round(trials * draws.uniform(0.02, 0.98));
            groups.push_back({true, hits + first, trials - hits + second});
        } else {
            const double exposure = draws.log_uniform(0.1, 100);
            const double events = std::round(exposure * draws.log_uniform(0.1, 30));
            groups.push_back({false, events + first, exposure + second});
        }
        exact *= groups.back().integral();
        offset += groups.back().most();
    }
    return {.ranges = box(n, 0, binomial ? 1 : infinity),
            .f =
                [=](const double* x) {
                    double total = -offset;
                    for (int j = 0; j < n; ++j) total += groups[j].logarithm(x[j]);
                    return std::exp(total);
                },
            .exact = exact,
            .parameters = words("n = ", n, binomial ? ", binomial" : ", Poisson", ", first powers ",
                                groups[0].k, ", ", groups[0].m),
            .accuracy = 1e-10};
}

HardIntegral categories(Draws& draws) {
    const int n = draws.integer(2, 5);
    const double most = draws.log_uniform(1, 60);
    std::vector<double> counts;
    double total = 0, offset = 0, log_exact = 0;
    for (int j = 0; j <= n; ++j) {
        counts.push_back(std::floor(draws.uniform(0, most + 1)));
        total += counts.back();
        log_exact += std::lgamma(counts.back() + 1);
    }
    log_exact -= std::lgamma(total + n + 1);
    for (double count : counts)
        if (count > 0) offset += count * std::log(count / total);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double last = 1, sum = -offset;
                    for (int j = 0; j < n; ++j) last -= x[j];
                    if (!(last > 0)) return 0.0;
                    for (int j = 0; j < n; ++j)
                        if (counts[j] > 0) sum += counts[j] * std::log(x[j]);
                    if (counts[n] > 0) sum += counts[n] * std::log(last);
                    return std::exp(sum);
                },
            .exact = std::exp(log_exact - offset),
            .parameters = words("n = ", n, ", ", total, " counts, the last ", counts[n]),
            .accuracy = 1e-11};
}

// x_j = load_j z + own noise: Sherman and Morrison's inverse in the density, one integral over z in the
// exact value.
HardIntegral orthant(Draws& draws) {
    const int n = draws.integer(2, 8);
    std::vector<Range> ranges;
    std::vector<double> load, own;
    double log_determinant = 0, coupling = 1;
    for (int j = 0; j < n; ++j) {
        load.push_back((draws.chance(0.15) ? -1 : 1) * draws.uniform(0.1, 0.97));
        own.push_back(1 - load[j] * load[j]);
        ranges.push_back({draws.uniform(-2, 1), infinity});
        log_determinant += std::log(own[j]);
        coupling += load[j] * load[j] / own[j];
    }
    log_determinant += std::log(coupling);
    const double constant = 0.5 * n * std::log(2 * pi) + 0.5 * log_determinant;
    const double exact = integrate_by_panels(-10, 10, 100, [&](double z) {
        double product = normal_density(z);
        for (int j = 0; j < n; ++j)
            product *= normal_cdf((load[j] * z - ranges[j].lower) / std::sqrt(own[j]));
        return product;
    });
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    double square = 0, along = 0;
                    for (int j = 0; j < n; ++j) {
                        square += x[j] * x[j] / own[j];
                        along += load[j] * x[j] / own[j];
                    }
                    return std::exp(-0.5 * (square - along * along / coupling) - constant);
                },
            .exact = exact,
            .parameters = words("n = ", n, ", first loads ", load[0], ", ", load[1])};
}

HardIntegral order_statistic(Draws& draws) {
    const int n = draws.integer(2, 12), kind = draws.integer(0, 2), k = draws.integer(1, n);
    const double power = draws.uniform(0.5, 6);
    double exact = 0;
    if (kind == 0)
        exact = std::exp(std::lgamma(n + 1.0) + std::lgamma(k + power) - std::lgamma(static_cast<double>(k)) -
                         std::lgamma(n + 1 + power));
    else if (kind == 1)
        for (int i = n - k + 1; i <= n; ++i) exact += 1.0 / i;
    else
        exact = (n - 1.0) / (n + 1);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    if (kind == 2) return *std::max_element(x, x + n) - *std::min_element(x, x + n);
                    std::array<double, 12> values{};
                    std::copy(x, x + n, values.begin());
                    std::nth_element(values.begin(), values.begin() + k - 1, values.begin() + n);
                    return kind == 0 ? std::pow(values[k - 1], power) : -std::log1p(-values[k - 1]);
                },
            .exact = exact,
            .parameters = kind == 2 ? words("range of ", n)
                                    : words("number ", k, " of ", n,
                                            kind == 0 ? words(", power ", power) : ", exponential")};
}

// The negative logarithm of the product of n uniform variables has the gamma law of shape n.
HardIntegral uniform_product(Draws& draws) {
    const int n = draws.integer(2, 8);
    if (draws.chance(0.4)) {
        const double power = draws.uniform(-1, 4);
        return {.ranges = box(n, 0, 1),
                .f =
                    [=](const double* x) {
                        double sum = 0;
                        for (int j = 0; j < n; ++j) sum -= std::log(x[j]);
                        return std::pow(sum, power);
                    },
                .exact = std::exp(std::lgamma(n + power) - std::lgamma(static_cast<double>(n))),
                .parameters = words("n = ", n, ", power ", power, " of the logarithm")};
    }
    const double gap = draws.chance(0.4) ? 0 : draws.log_uniform(1e-6, 0.1);
    const double series = gap == 0 ? boost::math::zeta(static_cast<double>(n))
                                   : integrate_by_panels(std::log(1e-16), std::log(60.0), 300, [&](double s) {
                                         const double t = std::exp(s);
                                         return std::exp(n * s - t - std::lgamma(static_cast<double>(n))) /
                                                (gap * std::exp(-t) - std::expm1(-t));
                                     });
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) product *= x[j];
                    return 1 / (1 - product + gap * product);
                },
            .exact = series,
            .parameters = words("n = ", n, ", polylogarithm, 1 - z = ", gap)};
}

// Sum of normal densities, each with axes of its own, at least 10 deviations from the ends of the box.
HardIntegral modes(Draws& draws) {
    const int n = draws.integer(2, 6), count = draws.integer(2, 3);
    const double half = n < 4 ? 15 : 6;
    struct Mode {
        std::vector<double> centre, width;
        std::vector<std::vector<double>> axes;
        double height;
    };
    std::vector<Mode> parts;
    double exact = 0;
    for (int k = 0; k < count; ++k) {
        Mode mode;
        mode.centre = draws.uniforms(n, -0.3 * half, 0.3 * half);
        mode.axes = random_axes(draws, n);
        const double mass = draws.uniform(0.05, 1);
        mode.height = mass;
        const double size = draws.log_uniform(n == 2 ? 0.02 : n == 3 ? 0.1 : 0.3, 1) * half / 15;
        for (int j = 0; j < n; ++j) {
            mode.width.push_back(size * draws.log_uniform(0.3, 1));
            mode.height /= std::sqrt(2 * pi) * mode.width.back();
        }
        exact += mass;
        parts.push_back(std::move(mode));
    }
    const std::string text = words("n = ", n, ", ", count, " modes, first widths ", parts[0].width[0], ", ",
                                   parts[1].width[0], ", box +-", half);
    return {.ranges = box(n, -half, half),
            .f =
                [=](const double* x) {
                    double total = 0;
                    for (const Mode& mode : parts) {
                        double square = 0;
                        for (int i = 0; i < n; ++i) {
                            double along = 0;
                            for (int j = 0; j < n; ++j) along += mode.axes[i][j] * (x[j] - mode.centre[j]);
                            square += along * along / (mode.width[i] * mode.width[i]);
                        }
                        total += mode.height * std::exp(-0.5 * square);
                    }
                    return total;
                },
            .exact = exact,
            .parameters = text};
}

constexpr HardFamily statistics_table[] = {
    {"conjugate",
     "beta-binomial (5..3000 trials) or gamma-Poisson (exposure 0.1..100) likelihoods of n in 1..5 groups "
     "over their largest values, over the unit cube or half-lines. Exact: beta and gamma functions",
     conjugate},
    {"categories",
     "multinomial likelihood of 3..6 categories with up to 1..60 counts each, 0 outside the simplex, over "
     "the unit cube. Exact: Dirichlet's integral",
     categories},
    {"orthant",
     "normal density, correlations from one factor with loads 0.1..0.97 of any sign, over [h_j, infinity), "
     "h_j in -2..1; n in 2..8. Exact: Gauss panels over the factor",
     orthant},
    {"order_statistic",
     "power 0.5..6, or exponential quantile, of the k-th least of n in 2..12 coordinates, or their range, "
     "over the unit cube. Exact: beta function, harmonic numbers",
     order_statistic},
    {"uniform_product",
     "(-log prod x_j)^p, p in -1..4, or 1 / (1 - z prod x_j), z = 1 or 1 - z log-uniform in 1e-6..0.1, over "
     "the unit cube; n in 2..8. Exact: gamma and zeta functions, Gauss panels over the logarithm",
     uniform_product},
    {"modes",
     "2 or 3 normal densities of any axes, masses 0.05..1, one size each, log-uniform in 0.02..1 (n = 2), "
     "0.1..1 (3), of a box +-15, or 0.12..0.4 of a box +-6; n in 2..6. Exact: the masses",
     modes},
};

} // namespace

std::span<const HardFamily> judging_statistics_families() { return statistics_table; }

} // namespace montelux::bench
