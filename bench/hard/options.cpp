// Financial options on geometric means, whose prices are closed, over the unit cube.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"

#include "montelux/mc/math/special.h"

namespace montelux::bench {

namespace {

// The logarithm of the mean is normal with `mean` and `deviation`; the strike lies `depth` deviations above
// its mean.
struct Contract {
    double mean, deviation, depth, discount;
    bool digital;

    double strike() const { return std::exp(mean + depth * deviation); }
    double payoff(double logarithm) const {
        const double k = strike(), value = std::exp(logarithm);
        if (digital) return value > k ? discount : 0;
        return value > k ? discount * (value - k) : 0;
    }
    double price() const {
        if (digital) return discount * normal_cdf(-depth);
        return discount * (std::exp(mean + 0.5 * deviation * deviation) * normal_cdf(deviation - depth) -
                           strike() * normal_cdf(-depth));
    }
    std::string text() const { return words(digital ? "digital" : "call", ", ", depth, " deviations out"); }
};

Contract draw_contract(Draws& draws, double mean, double deviation, double discount) {
    const bool digital = draws.chance(0.3);
    return {mean, deviation, draws.uniform(-0.5, digital ? 4 : 3.5), discount, digital};
}

// Geometric Asian option: the mean of a geometric Brownian motion from 1 at n equal times up to 1
// (Kemna, Vorst 1990), the path from its increments.
HardIntegral asian(Draws& draws) {
    const int n = draws.chance(0.5) ? 12 : 16;
    const double rate = draws.uniform(0, 0.1), sigma = draws.uniform(0.15, 0.5), step = 1.0 / n;
    const double drift = (rate - 0.5 * sigma * sigma) * step;
    const Contract contract =
        draw_contract(draws, drift * (n + 1) / 2, sigma * std::sqrt((n + 1.0) * (2 * n + 1) / (6.0 * n * n)),
                      std::exp(-rate));
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double at = 0, total = 0;
                    for (int j = 0; j < n; ++j) {
                        at += drift + sigma * std::sqrt(step) * normal_quantile(x[j]);
                        total += at;
                    }
                    return contract.payoff(total / n);
                },
            .exact = contract.price(),
            .parameters = words("Asian, n = ", n, ", ", contract.text())};
}

// Geometric basket of assets whose correlations come from one common factor, the first variable.
HardIntegral basket(Draws& draws) {
    const int assets = draws.integer(3, 8);
    const double rate = draws.uniform(0, 0.1), correlation = draws.uniform(0.1, 0.8);
    const std::vector<double> sigma = draws.uniforms(assets, 0.15, 0.5);
    double mean = 0, common = 0, own = 0;
    for (double s : sigma) {
        mean += (rate - 0.5 * s * s) / assets;
        common += s * std::sqrt(correlation) / assets;
        own += s * s * (1 - correlation) / (assets * assets);
    }
    const Contract contract = draw_contract(draws, mean, std::sqrt(common * common + own), std::exp(-rate));
    return {.ranges = box(assets + 1, 0, 1),
            .f =
                [=](const double* x) {
                    const double factor = std::sqrt(correlation) * normal_quantile(x[0]);
                    double total = mean;
                    for (int j = 0; j < assets; ++j)
                        total += sigma[j] *
                                 (factor + std::sqrt(1 - correlation) * normal_quantile(x[j + 1])) / assets;
                    return contract.payoff(total);
                },
            .exact = contract.price(),
            .parameters = words("basket, n = ", assets + 1, ", ", contract.text())};
}

HardIntegral option(Draws& draws) { return draws.chance(0.6) ? asian(draws) : basket(draws); }

constexpr HardFamily families[] = {
    {"option",
     "geometric Asian options of 12 or 16 dates, geometric baskets of 3..8 assets with a common factor, "
     "calls "
     "and digitals, the strike -0.5..3.5 (calls) or 4 deviations above the mean, by normal quantiles over "
     "the "
     "unit cube. Exact: the formula of Black and Scholes",
     option},
};

} // namespace

std::span<const HardFamily> option_families() { return families; }

} // namespace montelux::bench
