// Families of extreme numbers: scales, cancelling signs, constants; and Genz's, as controls.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"
#include "bench/integrate/integrands.h"
#include <memory>

namespace montelux::bench {

namespace {

// Of mean 1 over the unit cube.
HardIntegral of_mean_one(Draws& draws) {
    const int n = draws.integer(1, 5), kind = draws.integer(0, 3);
    std::string parameters;
    std::function<double(const double*)> f;
    double mean;
    if (kind == 0) {
        const double width = draws.log_uniform(0.03, 0.3);
        const std::vector<double> centre = draws.uniforms(n, 0.2, 0.8);
        mean = 1;
        for (double c : centre) mean *= gaussian_integral(0, 1, c, width);
        f = [=](const double* x) { return std::exp(-distance_squared(x, centre) / (2 * width * width)); };
        parameters = words("Gaussian of width ", width, ", n = ", n);
    } else if (kind == 1) {
        const std::vector<double> edge = draws.uniforms(n, 0.4, 0.9);
        mean = 1;
        for (double e : edge) mean *= e;
        f = [=](const double* x) {
            for (int j = 0; j < n; ++j)
                if (x[j] > edge[j]) return 0;
            return 1;
        };
        parameters = words("box, n = ", n);
    } else if (kind == 2) {
        const double radius = draws.uniform(0.3, 0.49);
        mean = std::pow(radius, n) * std::exp(0.5 * n * std::log(pi) - std::lgamma(0.5 * n + 1));
        f = [=](const double* x) {
            double square = 0;
            for (int j = 0; j < n; ++j) square += (x[j] - 0.5) * (x[j] - 0.5);
            return square < radius * radius ? 1 : 0;
        };
        parameters = words("ball of radius ", radius, ", n = ", n);
    } else {
        const std::vector<double> k = draws.uniforms(n, 1, 8), phase = draws.uniforms(n, 0, 2 * pi);
        mean = 1;
        for (int j = 0; j < n; ++j) mean *= 1 + 0.7 * (std::sin(k[j] + phase[j]) - std::sin(phase[j])) / k[j];
        f = [=](const double* x) {
            double product = 1;
            for (int j = 0; j < n; ++j) product *= 1 + 0.7 * std::cos(k[j] * x[j] + phase[j]);
            return product;
        };
        parameters = words("waves, n = ", n);
    }
    return {.ranges = box(n, 0, 1),
            .f = [=](const double* x) { return f(x) / mean; },
            .exact = 1,
            .parameters = parameters};
}

HardIntegral scale(Draws& draws) {
    const double exponent = draws.uniform(-300, 300), factor = std::pow(10, exponent);
    HardIntegral integral = of_mean_one(draws);
    integral.f = [f = integral.f, factor](const double* x) { return factor * f(x); };
    integral.exact = factor;
    integral.parameters += words(", times 10^", exponent);
    return integral;
}

HardIntegral nearly_constant(Draws& draws) {
    const double size = draws.chance(0.15) ? 0 : draws.log_uniform(1e-9, 1e-3);
    const double level = draws.uniform(0.5, 2);
    HardIntegral integral = of_mean_one(draws);
    integral.f = [f = integral.f, size, level](const double* x) {
        return size == 0 ? level : level + size * f(x);
    };
    integral.exact = level + size;
    integral.parameters += words(", times ", size, " on top of ", level);
    return integral;
}

// cos(p + c.x) less its mean, plus a share of the mean of |cos|.
HardIntegral cancelling(Draws& draws) {
    const int n = draws.integer(1, 6);
    const double share = draws.log_uniform(1e-3, 1e-2) * 2 / pi, phase = draws.uniform(0, 2 * pi);
    const std::vector<double> c = draws.uniforms(n, 3, 15);
    double mean = 1, middle = phase;
    for (double c_j : c) {
        mean *= std::sin(c_j / 2) / (c_j / 2);
        middle += c_j / 2;
    }
    const double constant = share - mean * std::cos(middle);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double sum = phase;
                    for (int j = 0; j < n; ++j) sum += c[j] * x[j];
                    return std::cos(sum) + constant;
                },
            .exact = share,
            .parameters = words("n = ", n, ", mean ", share),
            .accuracy = 1e-11};
}

HardIntegral genz(Draws& draws) {
    constexpr Family kinds[] = {Family::oscillatory, Family::product_peak, Family::corner_peak,
                                Family::gaussian,    Family::continuous,   Family::discontinuous};
    const Line line{kinds[draws.integer(0, 5)], draws.integer(2, BenchIntegrand::max_dimensions)};
    const auto seed = static_cast<std::uint64_t>(0x1p32 * draws.uniform());
    auto integrand = std::make_shared<const BenchIntegrand>(line, seed);
    return {.ranges = box(line.dimensions, 0, 1),
            .f = [integrand](const double* x) { return (*integrand)(x); },
            .exact = integrand->exact(),
            .parameters = line_name(line)};
}

constexpr HardFamily control_table[] = {
    {"scale",
     "10^k times a Gaussian, a box, a ball or waves of mean 1 over the unit cube; n in 1..5, k in -300..300. "
     "Exact: error functions, volumes, sines",
     scale},
    {"nearly_constant", "c + e g(x), g one of those, e = 0 or log-uniform in 1e-9..1e-3. Exact: c + e",
     nearly_constant},
    {"cancelling",
     "cos(p + c.x) less its mean, plus 1e-3..1e-2 (log-uniform) of the mean of |cos|, over the unit cube; n "
     "in "
     "1..6, c_j in 3..15. Exact: that constant",
     cancelling},
    {"genz", "Genz's six families (bench/integrate/integrands.h) in 2..8 variables, as controls", genz},
};

} // namespace

std::span<const HardFamily> control_families() { return control_table; }

} // namespace montelux::bench
