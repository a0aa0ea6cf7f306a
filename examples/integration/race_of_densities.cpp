// The integral of sin x over [0, pi/2], which is 1, by two densities that race with the same random numbers:
// p0 = 2 / pi and p1 = 8 x / pi^2. The second one's samples spread 14 times less.
#include "comparison.h"
#include <cmath>
#include <montelux/mc/dist/families.h>
#include <montelux/mc/integrate/basic_monte_carlo.h>
#include <montelux/mc/integrate/integrate.h>
#include <montelux/mc/integrate/techniques/importance.h>
#include <montelux/mc/math/constants.h>
#include <numbers>

using namespace montelux;

// Variances of sin X / p(X): pi^2/8 - 1, and (pi^2/16) (gamma + ln pi - Ci(pi)) - 1.
constexpr double cosine_integral_of_pi = 0.073667912046425485990;
constexpr double uniform_variance = pi * pi / 8 - 1;
const double linear_variance =
    pi * pi / 16 * (std::numbers::egamma + std::log(pi) - cosine_integral_of_pi) - 1;

int main() {
    Comparison comparison;
    const auto f = [](double x) { return std::sin(x); };
    const Domain domain = Domain::interval(0, pi / 2);

    // Each density by itself, to the same error at different cost.
    const auto by_uniform =
        integrate(f, domain, Importance{UniformDistribution(0, pi / 2)}, {.absolute_error = 2e-4});
    const auto by_linear =
        integrate(f, domain, Importance{LinearDistribution(0, pi / 2)}, {.absolute_error = 2e-4});
    std::cout << "uniform density: " << by_uniform << "\n\nlinear density: " << by_linear << "\n\n";
    comparison.add("integral by the uniform density", by_uniform.estimate(), 1);
    comparison.add("integral by the linear density", by_linear.estimate(), 1);

    // The race: both see the same xi. The variances are integrals over xi too, and have their own errors.
    const LinearDistribution linear(0, pi / 2);
    const auto race = Integrand::vector_valued(2, [&](std::span<const double> xi, std::span<double> y) {
        const double x0 = pi / 2 * xi[0], x1 = linear.sample(xi[0]);
        const double w0 = std::sin(x0) * pi / 2, w1 = std::sin(x1) / linear.pdf(x1);
        y[0] = (w0 - 1) * (w0 - 1);
        y[1] = (w1 - 1) * (w1 - 1);
    });
    const auto variances =
        integrate(race, Domain::unit_cube(1), BasicMonteCarlo{}, {.evaluations = 1'000'000});
    comparison.add("variance of a sample, uniform", variances.estimate(0), uniform_variance);
    comparison.add("variance of a sample, linear", variances.estimate(1), linear_variance);

    // Error of a quotient of correlated means, to first order.
    const double a = variances.value[0], b = variances.value[1], ratio = a / b;
    const auto& c = variances.covariance;
    const double error = ratio * std::sqrt(c[0] / (a * a) + c[3] / (b * b) - 2 * c[1] / (a * b));
    comparison.add("times less", {ratio, error}, uniform_variance / linear_variance);
    return comparison.exit_code();
}
