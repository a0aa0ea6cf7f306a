// Random variables by inversion, one section each: discrete, exponential, cosine, linear, quadratic, any
// function, and several variables. Means over samples beside their exact values.
#include "comparison.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <montelux/mc/dist/alias_table.h>
#include <montelux/mc/dist/closed_form_inversion.h>
#include <montelux/mc/dist/discrete.h>
#include <montelux/mc/dist/families.h>
#include <montelux/mc/dist/marginal_conditional.h>
#include <montelux/mc/dist/piecewise_1d.h>
#include <montelux/mc/dist/piecewise_2d.h>
#include <montelux/mc/dist/product.h>
#include <montelux/mc/math/constants.h>
#include <montelux/mc/stats/estimate.h>
#include <random>
#include <span>
#include <string>
#include <vector>

using namespace montelux;

std::mt19937_64 engine(2026);

double uniform() { return std::generate_canonical<double, 53>(engine); }

// The mean of a quantity that each call draws anew.
template <typename Draw>
Estimate mean(const Draw& draw, int samples = 100'000) {
    RunningMoments moments;
    for (int i = 0; i < samples; ++i) moments.add(draw());
    return Estimate::from_moments(moments);
}

void discrete(Comparison& comparison) {
    std::cout << "Discrete: weights 1, 2, 3, 4 of the values 0, 1, 2, 3\n";
    const std::array<double, 4> weights{1, 2, 3, 4};
    const DiscreteDistribution table(weights);
    const AliasTable alias{std::span<const double>(weights)};
    comparison.add("mean, by walking the sum", mean([&] { return table.sample_by_walking(uniform()).index; }),
                   2);
    comparison.add("mean, by bisection", mean([&] { return table.sample(uniform()).index; }), 2);
    comparison.add("mean, by an alias table", mean([&] { return alias.sample(uniform()).index; }), 2);
}

// Ten thousand values from the library and from the standard library, counted in bins of 0.1.
void exponential(Comparison& comparison) {
    constexpr double rate = 5, width = 0.1;
    constexpr int samples = 10'000, bins = 12;
    std::cout << "\nExponential: p = 5 e^(-5x), X = -ln(1 - xi) / 5, beside std::exponential_distribution\n";
    const ExponentialDistribution ours(rate);
    std::exponential_distribution<double> standard(rate);
    std::array<int, bins + 1> ours_seen{}, standard_seen{};
    RunningMoments ours_moments, standard_moments;
    for (int i = 0; i < samples; ++i) {
        const double x = ours(engine), y = standard(engine);
        ++ours_seen[std::min<std::size_t>(bins, static_cast<std::size_t>(x / width))];
        ++standard_seen[std::min<std::size_t>(bins, static_cast<std::size_t>(y / width))];
        ours_moments.add(x);
        standard_moments.add(y);
    }
    for (std::size_t b = 0; b < bins; ++b) {
        const double lower = static_cast<double>(b) * width;
        const std::string bar(static_cast<std::size_t>(ours_seen[b]) / 100, '*');
        std::printf("%.1f to %.1f: expected %6.1f, ours %4d, standard %4d  %s\n", lower, lower + width,
                    samples * (ours.cdf(lower + width) - ours.cdf(lower)), ours_seen[b], standard_seen[b],
                    bar.c_str());
    }
    std::fflush(stdout);
    comparison.add("mean, ours", Estimate::from_moments(ours_moments), 1 / rate);
    comparison.add("mean, the standard library's", Estimate::from_moments(standard_moments), 1 / rate);
}

void cosine(Comparison& comparison) {
    std::cout << "\nCosine: p = cos x on [0, pi/2), X = asin xi; with Y = xi in the plane\n";
    const CosineDistribution d;
    comparison.add("E X", mean([&] { return d(engine); }), pi / 2 - 1);
    const ProductDistribution plane{CosineDistribution(), UniformDistribution()};
    comparison.add("E XY", mean([&] {
                       const double xi_x = uniform();
                       const double xi_y = uniform();
                       const auto p = plane.sample({xi_x, xi_y});
                       return p[0] * p[1];
                   }),
                   (pi / 2 - 1) / 2);
}

void linear(Comparison& comparison) {
    std::cout << "\nLinear: p = 2v on [0, 1), X = sqrt(xi); on [2, 4), X = 2 sqrt(3 xi + 1)\n";
    const LinearDistribution unit, restricted(2, 4);
    comparison.add("E X on [0, 1)", mean([&] { return unit(engine); }), 2.0 / 3);
    comparison.add("E X on [2, 4)", mean([&] { return restricted(engine); }), 28.0 / 9);
}

void quadratic(Comparison& comparison) {
    std::cout << "\nQuadratic: p = 3x^2/2 on [-1, 1], X = cbrt(2 xi - 1)\n";
    const QuadraticDistribution d;
    comparison.add("E X", mean([&] { return d(engine); }), 0);
    comparison.add("E X^2", mean([&] {
                       const double x = d(engine);
                       return x * x;
                   }),
                   0.6);
}

// The mean of X^2 over a law that is given in any way.
template <typename D>
Estimate second_moment(const D& d) {
    return mean([&] {
        const double x = sample_by_inversion(d, uniform());
        return x * x;
    });
}

void recipe(Comparison& comparison) {
    std::cout << "\nThe inversion method for sin x on [0, pi]: F = -cos x, c = 2\n";
    const auto f = [](double x) { return std::sin(x); };
    const auto antiderivative = [](double x) { return -std::cos(x); };
    const auto inverse = [](double y) { return std::acos(-y); };
    const double exact = (pi * pi - 4) / 2;
    comparison.add("E X^2, from f alone", second_moment(inversion(f, 0, pi)), exact);
    comparison.add("E X^2, with F", second_moment(inversion(f, antiderivative, 0, pi)), exact);
    comparison.add("E X^2, with F and its inverse",
                   second_moment(inversion(f, antiderivative, inverse, 0, pi)), exact);
    // Pieces [0, 1) to [3, 4); and a hat over [0, 2].
    const PiecewiseConstant1D steps(std::array<double, 4>{1, 3, 0, 2}, 0, 4);
    comparison.add("E X, from a table of steps", mean([&] { return steps.sample(uniform()).x; }), 2);
    const PiecewiseLinear1D hat(std::array<double, 3>{0, 1, 0}, 0, 2);
    comparison.add("E X^2, from a table of nodes", second_moment(hat), 7.0 / 6);
}

void several(Comparison& comparison) {
    std::cout << "\nSeveral variables: independent, marginal then conditional, tabulated\n";
    const RuntimeProduct<NormalDistribution> normals(std::vector<NormalDistribution>(5));
    comparison.add("E |X|^2, five normal variables", mean([&] {
                       std::array<double, 5> x{};
                       for (double& xi : x) xi = uniform();
                       normals.sample(x, x);
                       double square = 0;
                       for (double v : x) square += v * v;
                       return square;
                   }),
                   5);
    // Uniform over the triangle 0 <= y <= x <= 1.
    const MarginalConditional triangle(LinearDistribution(),
                                       [](double x) { return UniformDistribution(0, x); });
    comparison.add("E XY, p(x) = 2x and p(y | x) = 1/x", mean([&] {
                       const double xi_x = uniform();
                       const double xi_y = uniform();
                       const auto p = triangle.sample({xi_x, xi_y});
                       return p[0] * p[1];
                   }),
                   0.25);
    const PiecewiseConstant2D table(std::array<double, 4>{1, 2, 3, 4}, 2, 2);
    comparison.add("E XY, a table of 2 x 2 cells", mean([&] {
                       const double xi_x = uniform();
                       const double xi_y = uniform();
                       const Vec2d p = table.sample(Vec2d(xi_x, xi_y)).p;
                       return p.x * p.y;
                   }),
                   0.325);
}

int main() {
    Comparison comparison(4); // wider, since one of this many comparisons would sometimes exceed three errors
    discrete(comparison);
    exponential(comparison);
    cosine(comparison);
    linear(comparison);
    quadratic(comparison);
    recipe(comparison);
    several(comparison);
    return comparison.exit_code();
}
