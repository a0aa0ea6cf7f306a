// Expectations over a posterior: logistic regression of how many beetles die of a dose of carbon disulphide
// (Bliss 1935, "The calculation of the dosage-mortality curve"), with wide normal priors. Metropolis needs
// the density only up to a constant; with two parameters quadrature can check the result.
#include "comparison.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <montelux/mc/integrate/cubature/cubature.h>
#include <montelux/mc/integrate/integrate.h>
#include <montelux/mc/integrate/metropolis/metropolis_chain.h>
#include <span>
#include <vector>

using namespace montelux;
using Point = std::span<const double>;

struct Group {
    double dose; // log10 of mg / l
    int beetles, killed;
};
constexpr std::array<Group, 8> groups{{{1.6907, 59, 6},
                                       {1.7242, 60, 13},
                                       {1.7552, 62, 18},
                                       {1.7842, 56, 28},
                                       {1.8113, 63, 52},
                                       {1.8369, 59, 53},
                                       {1.8610, 62, 61},
                                       {1.8839, 60, 60}}};
constexpr double middle = 1.8; // of the doses, so that the two parameters are nearly independent

// P(death) = 1 / (1 + exp(-a - b (dose - middle))), a ~ normal(0, 10), b ~ normal(0, 100).
double log_posterior(Point x) {
    const double a = x[0], b = x[1];
    double sum = -0.5 * (a * a / 100 + b * b / 10000);
    for (const Group& g : groups) {
        const double logit = a + b * (g.dose - middle);
        sum += g.killed * logit - g.beetles * (std::max(logit, 0.0) + std::log1p(std::exp(-std::abs(logit))));
    }
    return sum;
}

constexpr std::array<const char*, 3> names{"slope", "dose that kills half", "P(death at 1.75)"};
void observe(Point x, std::span<double> y) {
    y[0] = x[1];
    y[1] = middle - x[0] / x[1];
    y[2] = 1 / (1 + std::exp(-x[0] - x[1] * (1.75 - middle)));
}

int main() {
    const std::vector<std::vector<double>> starts{{-1, 20}, {0, 50}, {2, 30}, {3, 45}};
    const MetropolisResult chains =
        metropolis(log_posterior, GaussianWalk{0, {0.2, 3}}, starts, 3, observe, {.samples = 100'000});
    for (std::size_t i = 0; i < 3; ++i)
        std::printf("%-20s  R-hat %.4f, effective samples %.0f of 400000, autocorrelation time %.1f\n",
                    names[i], chains.observables[i].r_hat, chains.observables[i].effective_sample_size,
                    chains.observables[i].autocorrelation_time);
    std::printf("acceptance rate %.2f\n\n", chains.acceptance_rate);

    // Moments of the posterior by quadrature over a box that leaves out less than 1e-9 of it.
    const double top = log_posterior(std::array{0.74, 34.0});
    const auto moments = Integrand::vector_valued(4, [=](Point x, std::span<double> y) {
        observe(x, y);
        y[3] = std::exp(log_posterior(x) - top);
        for (std::size_t i = 0; i < 3; ++i) y[i] *= y[3];
    });
    const auto q = integrate(moments, Domain{{-1, 3}, {10, 65}}, Cubature{}, {.relative_error = 1e-7});

    Comparison comparison;
    for (std::size_t i = 0; i < 3; ++i)
        comparison.add(names[i], {chains.observables[i].mean, chains.observables[i].standard_error},
                       q.value[i] / q.value[3], 2e-7 * q.value[i] / q.value[3]);
    for (const std::string& warning : chains.warnings) std::cout << "warning: " << warning << "\n";
    return comparison.exit_code() | !chains.warnings.empty();
}
