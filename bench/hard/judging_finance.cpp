// Judging families of finance: options on several assets and on paths, jumps of prices, losses of portfolios.
#include "bench/hard/judging.h"
#include <algorithm>

#include "montelux/mc/math/special.h"

namespace montelux::bench {

namespace {

// max(largest discounted price - strike, 0) of independent assets, and the option to exchange two.
HardIntegral rainbow(Draws& draws) {
    const bool exchange = draws.chance(0.4), over_space = draws.chance(0.3);
    const int n = exchange ? 2 : draws.integer(2, 6);
    const std::vector<double> start = draws.uniforms(n, 0.7, 1.3), sigma = draws.uniforms(n, 0.1, 0.6);
    const double strike = draws.uniform(0.8, 2), correlation = draws.uniform(-0.5, 0.9);
    const double across = std::sqrt(1 - correlation * correlation);
    double exact;
    if (exchange) { // Margrabe
        const double s =
            std::sqrt(sigma[0] * sigma[0] + sigma[1] * sigma[1] - 2 * correlation * sigma[0] * sigma[1]);
        const double d = std::log(start[0] / start[1]) / s + s / 2;
        exact = start[0] * normal_cdf(d) - start[1] * normal_cdf(d - s);
    } else { // the integral of P(largest > m) from the strike up, m = strike exp(t)
        exact = integrate_by_panels(0, 8, 64, [&](double t) {
            double log_below = 0;
            for (int j = 0; j < n; ++j)
                log_below += std::log1p(
                    -normal_cdf((std::log(start[j] / strike) - t - sigma[j] * sigma[j] / 2) / sigma[j]));
            return -std::expm1(log_below) * strike * std::exp(t);
        });
    }
    auto payoff = [=](const double* z) {
        auto price = [&](int j, double normal) {
            return start[j] * std::exp(sigma[j] * normal - sigma[j] * sigma[j] / 2);
        };
        if (exchange) return std::max(0.0, price(0, z[0]) - price(1, correlation * z[0] + across * z[1]));
        double most = strike;
        for (int j = 0; j < n; ++j) most = std::max(most, price(j, z[j]));
        return most - strike;
    };
    return {.ranges = over_space ? box(n, -12, 12) : box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double z[6], density = 1;
                    for (int j = 0; j < n; ++j) {
                        z[j] = over_space ? x[j] : normal_quantile(x[j]);
                        if (over_space) density *= normal_density(x[j]);
                    }
                    return density * payoff(z);
                },
            .exact = exact,
            .parameters =
                words("n = ", n,
                      exchange ? words(", exchange, correlation ", correlation)
                               : words(", best of, strike ", strike),
                      ", first volatilities ", sigma[0], ", ", sigma[1], over_space ? ", over +-12" : "")};
}

// Logarithm of the price from 0 at time 0 to time 1.
struct Motion {
    double rate, sigma;

    double drift() const { return rate - 0.5 * sigma * sigma; }
};

// Knock-out call, the path between dates by the probability that a bridge stays on its side: the mean is that
// of continuous observation. Exact: the density by reflection.
HardIntegral barrier(Draws& draws) {
    const Motion motion{draws.uniform(0, 0.08), draws.uniform(0.15, 0.5)};
    const int n = draws.integer(1, 12);
    const bool up = draws.chance(0.5);
    const double b = (up ? 1 : -1) * motion.sigma * draws.uniform(0.3, 2);
    const double log_strike = up ? b - motion.sigma * draws.uniform(0.5, 2) : draws.uniform(-0.2, 0.4);
    const double strike = std::exp(log_strike), discount = std::exp(-motion.rate), s = motion.sigma;
    const double step = 1.0 / n, drift = motion.drift();
    const double from = up ? log_strike : std::max(log_strike, b), to = up ? b : from + 12 * s;
    const double exact = integrate_by_panels(from, to, 64, [&](double x) {
        const double density = normal_density((x - drift) / s) -
                               std::exp(2 * drift * b / (s * s)) * normal_density((x - 2 * b - drift) / s);
        return discount * (std::exp(x) - strike) * density / s;
    });
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* u) {
                    double at = 0, survival = 1;
                    for (int j = 0; j < n; ++j) {
                        const double next = at + drift * step + s * std::sqrt(step) * normal_quantile(u[j]);
                        if ((next - b) * b >= 0) return 0.0;
                        survival *= -std::expm1(-2 * (b - at) * (b - next) / (s * s * step));
                        at = next;
                    }
                    return survival * discount * std::max(0.0, std::exp(at) - strike);
                },
            .exact = exact,
            .parameters = words("n = ", n, up ? ", up" : ", down", " and out at ", std::exp(b), ", strike ",
                                strike, ", volatility ", s)};
}

// Call on the largest price of the path, the largest of each bridge by inversion of its law.
HardIntegral lookback(Draws& draws) {
    const Motion motion{draws.uniform(0, 0.08), draws.uniform(0.1, 0.5)};
    const int steps = draws.integer(1, 6);
    const double s = motion.sigma, drift = motion.drift(), step = 1.0 / steps;
    const double log_strike = s * draws.uniform(0, 2.5), discount = std::exp(-motion.rate);
    const double exact =
        discount * integrate_by_panels(log_strike, log_strike + 14 * s, 64, [&](double y) {
            return std::exp(y) * (normal_cdf((drift - y) / s) +
                                  std::exp(2 * drift * y / (s * s)) * normal_cdf((-y - drift) / s));
        });
    return {.ranges = box(2 * steps, 0, 1),
            .f =
                [=](const double* u) {
                    double at = 0, most = 0;
                    for (int j = 0; j < steps; ++j) {
                        const double move = drift * step + s * std::sqrt(step) * normal_quantile(u[2 * j]);
                        const double spread = move * move - 2 * s * s * step * std::log(u[2 * j + 1]);
                        most = std::max(most, at + 0.5 * (move + std::sqrt(spread)));
                        at += move;
                    }
                    return discount * std::max(0.0, std::exp(most) - std::exp(log_strike));
                },
            .exact = exact,
            .parameters = words("n = ", 2 * steps, ", strike ", std::exp(log_strike), ", volatility ", s)};
}

// Merton: a Poisson number of normal jumps, from the first variable by inversion.
HardIntegral jump_diffusion(Draws& draws) {
    const Motion motion{draws.uniform(0, 0.08), draws.uniform(0.1, 0.4)};
    const double intensity = draws.log_uniform(0.1, 5), size = draws.uniform(-0.3, 0.1);
    const double deviation = draws.uniform(0.02, 0.3), strike = draws.uniform(0.8, 1.5);
    const double start = motion.drift() - intensity * std::expm1(size + deviation * deviation / 2);
    const double discount = std::exp(-motion.rate);
    const bool separate = draws.chance(0.5); // jumps have a variable of their own
    double exact = 0;
    std::vector<double> cumulative;
    for (int k = 0; k < 60; ++k) {
        const double share = std::exp(k * std::log(intensity) - intensity - std::lgamma(k + 1.0));
        cumulative.push_back(share + (k > 0 ? cumulative.back() : 0));
        const double mean = start + k * size;
        const double s = std::sqrt(motion.sigma * motion.sigma + k * deviation * deviation);
        const double d = (mean - std::log(strike)) / s;
        exact += share * discount * (std::exp(mean + s * s / 2) * normal_cdf(d + s) - strike * normal_cdf(d));
    }
    return {.ranges = box(separate ? 3 : 2, 0, 1),
            .f =
                [=](const double* u) {
                    const auto jumps =
                        static_cast<double>(std::upper_bound(cumulative.begin(), cumulative.end() - 1, u[0]) -
                                            cumulative.begin());
                    const double z = normal_quantile(u[1]), variance = jumps * deviation * deviation;
                    const double noise = separate
                                             ? motion.sigma * z + std::sqrt(variance) * normal_quantile(u[2])
                                             : std::sqrt(motion.sigma * motion.sigma + variance) * z;
                    return discount * std::max(0.0, std::exp(start + jumps * size + noise) - strike);
                },
            .exact = exact,
            .parameters = words("n = ", separate ? 3 : 2, ", ", intensity, " jumps of ", size, " +- ",
                                deviation, ", strike ", strike)};
}

// Vasicek: debtor j defaults if its variable lies below a level that depends on the first one. The loss is
// what defaults exceed `attachment`, to at most `width`, over the width.
HardIntegral tranche(Draws& draws) {
    const int debtors = draws.integer(4, 20), attachment = draws.integer(0, 2), width = draws.integer(1, 3);
    const double p = draws.log_uniform(0.005, 0.2), correlation = draws.uniform(0.05, 0.6);
    const double level = normal_quantile(p);
    auto conditional = [=](double z) {
        return normal_cdf((level - std::sqrt(correlation) * z) / std::sqrt(1 - correlation));
    };
    auto loss = [=](int defaults) {
        return static_cast<double>(std::clamp(defaults - attachment, 0, width)) / width;
    };
    const double exact = integrate_by_panels(-12, 12, 100, [&](double z) {
        const double q = conditional(z);
        double total = 0;
        for (int k = 1; k <= debtors; ++k) {
            const double choose = std::round(
                std::exp(std::lgamma(debtors + 1.0) - std::lgamma(k + 1.0) - std::lgamma(debtors - k + 1.0)));
            total += loss(k) * choose * std::pow(q, k) * std::pow(1 - q, debtors - k);
        }
        return normal_density(z) * total;
    });
    return {.ranges = box(debtors + 1, 0, 1),
            .f =
                [=](const double* u) {
                    const double q = conditional(normal_quantile(u[0]));
                    int defaults = 0;
                    for (int j = 1; j <= debtors; ++j) defaults += u[j] < q ? 1 : 0;
                    return loss(defaults);
                },
            .exact = exact,
            .parameters = words(debtors, " debtors, p = ", p, ", correlation ", correlation, ", tranche ",
                                attachment, " to ", attachment + width)};
}

// Mean of exp(c.z), z normal.
HardIntegral tilt(Draws& draws) {
    const int n = draws.integer(10, 40);
    std::vector<double> c = draws.uniforms(n, -1, 1);
    const double norm = draws.uniform(0.3, 2.5), power = draws.chance(0.5) ? 0 : draws.uniform(0.5, 2);
    double square = 0;
    for (int j = 0; j < n; ++j) {
        c[j] *= std::pow(j + 1, -power);
        square += c[j] * c[j];
    }
    for (double& c_j : c) c_j *= norm / std::sqrt(square);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* u) {
                    double sum = 0;
                    for (int j = 0; j < n; ++j) sum += c[j] * normal_quantile(u[j]);
                    return std::exp(sum);
                },
            .exact = std::exp(0.5 * norm * norm),
            .parameters = words("n = ", n, ", norm ", norm, ", falling as j^-", power)};
}

constexpr HardFamily finance_table[] = {
    {"rainbow",
     "option to exchange two correlated assets, or call on the best of 2..6 independent ones, strike 0.8..2, "
     "volatilities 0.1..0.6; by normal quantiles over the unit cube, or with the normal density over +-12. "
     "Exact: Margrabe's formula, Gauss panels over the law of the largest",
     rainbow},
    {"barrier",
     "knock-out calls of 1..12 dates with the survival of Brownian bridges between, barrier 0.3..2 "
     "deviations away, over the unit cube. Exact: Gauss panels over the reflected density",
     barrier},
    {"lookback",
     "calls on the largest price of 1..6 Brownian bridges, strike 0..2.5 deviations out, over the unit cube; "
     "n in 2..12. Exact: Gauss panels over the law of the largest value",
     lookback},
    {"jump_diffusion",
     "Merton's calls: a Poisson number of jumps (mean 0.1..5) by inversion, normal quantiles, over the unit "
     "cube; n in 2, 3. Exact: Merton's series",
     jump_diffusion},
    {"tranche",
     "loss of a tranche of 4..20 debtors with one common normal factor, default probability log-uniform in "
     "0.005..0.2, correlation 0.05..0.6, over the unit cube. Exact: Gauss panels over the factor",
     tranche},
    {"tilt",
     "exp(c.z), z normal quantiles, |c| in 0.3..2.5, equal or falling coefficients, over the unit cube; n in "
     "10..40. Exact: exp(|c|^2 / 2)",
     tilt},
};

} // namespace

std::span<const HardFamily> judging_finance_families() { return finance_table; }

} // namespace montelux::bench
