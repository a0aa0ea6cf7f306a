// The price of a call on the mean of six stocks that follow correlated geometric Brownian motions (Black and
// Scholes 1973). The call on their geometric mean has a closed form: it is a test, and as a control variate
// it removes most of the variance.
#include "comparison.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <montelux/mc/dist/families.h>
#include <montelux/mc/integrate/integrate.h>
#include <montelux/mc/integrate/techniques/control_variate.h>
#include <numeric>
#include <utility>

using namespace montelux;

constexpr std::size_t stocks = 6;
constexpr double strike = 100, rate = 0.03, years = 1;
constexpr std::array<double, stocks> price{100, 95, 110, 90, 105, 100};
constexpr std::array<double, stocks> volatility{0.2, 0.25, 0.3, 0.35, 0.2, 0.15}; // a root year
double correlation(std::size_t i, std::size_t j) { return i == j ? 1 : i / 3 == j / 3 ? 0.6 : 0.3; }

// Cholesky's L: correlations = L times L transposed.
auto cholesky() {
    std::array<std::array<double, stocks>, stocks> l{};
    for (std::size_t i = 0; i < stocks; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double rest = correlation(i, j);
            for (std::size_t k = 0; k < j; ++k) rest -= l[i][k] * l[j][k];
            l[i][j] = i == j ? std::sqrt(rest) : rest / l[j][j];
        }
    return l;
}

// Discounted payoffs on the arithmetic and the geometric mean; a point of the unit cube is one future.
std::pair<double, double> payoff(std::span<const double> u) {
    static const auto l = cholesky();
    static const NormalDistribution normal;
    std::array<double, stocks> n;
    std::transform(u.begin(), u.end(), n.begin(), [](double xi) { return normal.sample(xi); });
    double sum = 0, log_sum = 0;
    for (std::size_t i = 0; i < stocks; ++i) {
        const double s = volatility[i] * std::sqrt(years);
        const double z = std::inner_product(n.begin(), n.end(), l[i].begin(), 0.0);
        const double log_price = std::log(price[i]) + rate * years - s * s / 2 + s * z;
        sum += std::exp(log_price);
        log_sum += log_price;
    }
    const auto call = [](double mean) { return std::exp(-rate * years) * std::max(0.0, mean - strike); };
    return {call(sum / stocks), call(std::exp(log_sum / stocks))};
}

double exact_geometric() {
    double mean = 0, variance = 0; // of the logarithm of the geometric mean
    for (std::size_t i = 0; i < stocks; ++i) {
        mean += (std::log(price[i]) + (rate - 0.5 * volatility[i] * volatility[i]) * years) / stocks;
        for (std::size_t j = 0; j < stocks; ++j)
            variance += correlation(i, j) * volatility[i] * volatility[j] * years / (stocks * stocks);
    }
    const NormalDistribution normal;
    const double d = (mean - std::log(strike)) / std::sqrt(variance); // Black's formula
    return std::exp(-rate * years) *
           (std::exp(mean + variance / 2) * normal.cdf(d + std::sqrt(variance)) - strike * normal.cdf(d));
}

int main() {
    const auto arithmetic = [](std::span<const double> u) { return payoff(u).first; };
    const auto geometric = [](std::span<const double> u) { return payoff(u).second; };
    const Domain cube = Domain::unit_cube(stocks);
    const auto plain = integrate(arithmetic, cube, Method(), {.relative_error = 1e-4});
    const auto test = integrate(geometric, cube, Method(), {.relative_error = 1e-4});
    const ControlVariate control{geometric, {exact_geometric()}};
    const auto controlled = integrate(arithmetic, cube, control, {.evaluations = 1'000'000});
    std::cout << "call on the mean: " << plain << "\n\nwith the control variate: " << controlled << "\n\n";

    Comparison comparison;
    comparison.add("call on the geometric mean", test.estimate(), exact_geometric());
    comparison.add("call on the mean", plain.estimate(), controlled.value[0], controlled.standard_error[0]);
    return comparison.exit_code();
}
