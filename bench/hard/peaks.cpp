// Families of smooth peaks: eggboxes, mixtures of Gaussians, spikes on plateaus, bumps.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"

namespace montelux::bench {

namespace {

HardIntegral eggbox(Draws& draws) {
    const double upper = 10 * pi_;
    const int power = draws.integer(2, 5);
    const double kx = draws.uniform(0.4, 0.6), ky = draws.uniform(0.4, 0.6);
    const double px = draws.uniform(0, 2 * pi_), py = draws.uniform(0, 2 * pi_);
    auto value = [power](double product) { return std::exp(std::pow(2 + product, power)); };
    // Panels of 0.3 in the phase, where the narrowest peak has a standard deviation of 0.05.
    std::vector<double> cosines[2], weights[2];
    for (int axis = 0; axis < 2; ++axis) {
        const double k = axis == 0 ? kx : ky, p = axis == 0 ? px : py;
        integrate_by_panels(0, upper, static_cast<int>(upper * k / 0.3) + 1, [&](double x) {
            cosines[axis].push_back(std::cos(k * x + p));
            return 0;
        });
        const auto& rule = GaussLegendre<20>::rule();
        const double half = upper / (static_cast<int>(upper * k / 0.3) + 1) / 2;
        for (std::size_t i = 0; i < cosines[axis].size(); ++i)
            weights[axis].push_back(half * rule.weights[i % 20]);
    }
    double exact = 0;
    for (std::size_t i = 0; i < cosines[0].size(); ++i) {
        double row = 0;
        for (std::size_t j = 0; j < cosines[1].size(); ++j)
            row += weights[1][j] * value(cosines[0][i] * cosines[1][j]);
        exact += weights[0][i] * row;
    }
    return {.ranges = box(2, 0, upper),
            .f = [=](const double* x) { return value(std::cos(kx * x[0] + px) * std::cos(ky * x[1] + py)); },
            .exact = exact,
            .parameters = words("power ", power, ", frequencies ", kx, ", ", ky),
            .accuracy = 1e-11};
}

struct Component {
    double weight;
    std::vector<double> centre, width;
};

HardIntegral mixture_of(int n, std::vector<Component> components, std::string parameters) {
    double exact = 0;
    for (const Component& component : components) {
        double product = component.weight;
        for (std::size_t j = 0; j < component.centre.size(); ++j)
            product *= gaussian_integral(0, 1, component.centre[j], component.width[j]);
        exact += product;
    }
    return {.ranges = box(n, 0, 1),
            .f =
                [components = std::move(components)](const double* x) {
                    double total = 0;
                    for (const Component& component : components) {
                        double exponent = 0;
                        for (std::size_t j = 0; j < component.centre.size(); ++j) {
                            const double t = (x[j] - component.centre[j]) / component.width[j];
                            exponent += t * t;
                        }
                        total += component.weight * std::exp(-0.5 * exponent);
                    }
                    return total;
                },
            .exact = exact,
            .parameters = std::move(parameters)};
}

HardIntegral mixture(Draws& draws) {
    const int n = draws.integer(1, 10), count = draws.integer(2, 20);
    const double width = draws.log_uniform(n <= 3 ? 0.003 : 0.02, 0.2);
    std::vector<Component> components;
    for (int k = 0; k < count; ++k)
        components.push_back({draws.uniform(0.2, 1), draws.uniforms(n, 0.05, 0.95),
                              std::vector<double>(static_cast<std::size_t>(n), width)});
    return mixture_of(n, std::move(components), words("n = ", n, ", ", count, " Gaussians of width ", width));
}

HardIntegral mixture_of_widths(Draws& draws) {
    const int n = draws.integer(1, 5), count = draws.integer(2, 20);
    const double least = n == 1 ? 0.003 : n == 2 ? 0.01 : 0.05;
    std::vector<Component> components;
    double narrowest = 1;
    for (int k = 0; k < count; ++k) {
        Component component{draws.uniform(0.2, 1), draws.uniforms(n, 0.05, 0.95), {}};
        for (int j = 0; j < n; ++j) {
            component.width.push_back(draws.log_uniform(least, 0.2));
            narrowest = std::min(narrowest, component.width.back());
            // So that narrow components count, each has the mass that it would have with width 0.1.
            component.weight *= 0.1 / component.width.back();
        }
        components.push_back(std::move(component));
    }
    return mixture_of(n, std::move(components),
                      words("n = ", n, ", ", count, " Gaussians, the narrowest width ", narrowest));
}

HardIntegral spike(Draws& draws) {
    const int n = draws.integer(1, 3);
    const double s = n < 3 ? draws.log_uniform(0.002, 0.02) : draws.log_uniform(0.02, 0.05);
    const double share = draws.uniform(0.2, 0.8);
    const std::vector<double> centre = draws.uniforms(n, 0.1, 0.9);
    const bool varies = draws.chance(0.5);
    const std::vector<double> frequency = draws.uniforms(n, 0.5, 2), phase = draws.uniforms(n, 0, 2 * pi_);
    auto plateau = [=](const double* x) {
        double product = 1;
        for (int j = 0; j < n && varies; ++j)
            product *= 1 + 0.5 * std::cos(2 * pi_ * frequency[j] * x[j] + phase[j]);
        return product;
    };
    double below = 1, under_spike = 1;
    for (int j = 0; j < n; ++j) {
        const double k = 2 * pi_ * frequency[j];
        if (varies) below *= 1 + 0.5 * (std::sin(k + phase[j]) - std::sin(phase[j])) / k;
        under_spike *= gaussian_integral(0, 1, centre[j], s);
    }
    const double height = share / (1 - share) * below / under_spike;
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    return plateau(x) + height * std::exp(-distance_squared(x, centre) / (2 * s * s));
                },
            .exact = below + height * under_spike,
            .parameters = words("n = ", n, ", width ", s, ", share ", share, varies ? ", waves" : ", flat")};
}

HardIntegral bump(Draws& draws) {
    const int n = draws.integer(2, 5);
    const double radius = draws.log_uniform(0.05, 0.2);
    const std::vector<double> centre = draws.uniforms(n, radius, 1 - radius);
    auto profile = [radius](double square) {
        const double t = 1 - square / (radius * radius);
        return t > 0 ? std::exp(1 - 1 / t) : 0;
    };
    return {.ranges = box(n, 0, 1),
            .f = [=](const double* x) { return profile(distance_squared(x, centre)); },
            .exact = radial_integral(n, 0, radius, 64, [&](double r) { return profile(r * r); }),
            .parameters = words("n = ", n, ", radius ", radius)};
}

constexpr HardFamily families[] = {
    {"eggbox",
     "exp((2 + cos(k x + p) cos(l y + q))^m) over [0, 10 pi]^2; m in 2..5, k and l in 0.4..0.6, any phases. "
     "Exact: product of Gauss panels",
     eggbox},
    {"mixture",
     "sum of 2..20 Gaussians, weights 0.2..1, one common width, over the unit cube; n in 1..10; width "
     "log-uniform in 0.003..0.2, from 4 variables in 0.02..0.2. Exact: error functions",
     mixture},
    {"mixture_of_widths",
     "sum of 2..20 Gaussians of about equal mass, a width for each axis of each, over the unit cube; n in "
     "1..5; widths log-uniform in 0.003..0.2 (n = 1), 0.01..0.2 (2), 0.05..0.2. Exact: error functions",
     mixture_of_widths},
    {"spike",
     "1 or prod(1 + cos(k x + p) / 2), plus a Gaussian of width 0.002..0.02 (n = 1, 2) or 0.02..0.05 (n = 3) "
     "with 0.2..0.8 of the integral, over the unit cube. Exact: error functions, sines",
     spike},
    {"bump",
     "exp(1 - 1 / (1 - |x - c|^2 / R^2)) inside the ball of radius R, else 0, over the unit cube; n in 2..5, "
     "R "
     "log-uniform in 0.05..0.2. Exact: radial Gauss panels",
     bump},
};

} // namespace

std::span<const HardFamily> peak_families() { return families; }

} // namespace montelux::bench
