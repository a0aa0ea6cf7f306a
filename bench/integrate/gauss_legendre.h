// Gauss-Legendre quadrature in one dimension, for reference values.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace montelux::bench {

// Nodes in (-1, 1) and weights of the rule of N points, which is exact for polynomials of degree 2 N - 1.
// Roots of the Legendre polynomial by Newton's method from the cosine guess.
template <std::size_t N>
struct GaussLegendre {
    std::array<double, N> nodes, weights;

    GaussLegendre() {
        for (std::size_t i = 0; i < N; ++i) {
            long double x = std::cos(std::numbers::pi_v<long double> * (i + 0.75L) / (N + 0.5L)), slope = 1;
            for (int step = 0; step < 8; ++step) {
                long double p = 1, previous = 0;
                for (std::size_t k = 1; k <= N; ++k) {
                    const long double next = ((2 * k - 1) * x * p - (k - 1) * previous) / k;
                    previous = p;
                    p = next;
                }
                slope = N * (x * p - previous) / (x * x - 1);
                x -= p / slope;
            }
            nodes[i] = static_cast<double>(x);
            weights[i] = static_cast<double>(2 / ((1 - x * x) * slope * slope));
        }
    }
    static const GaussLegendre& rule() {
        static const GaussLegendre instance;
        return instance;
    }
};

// The integral of f over [a, b] by this many equal panels of 20 nodes.
template <typename F>
double integrate_by_panels(double a, double b, int panels, const F& f) {
    constexpr std::size_t n = 20;
    const auto& rule = GaussLegendre<n>::rule();
    const double half = (b - a) / panels / 2;
    double total = 0;
    for (int panel = 0; panel < panels; ++panel) {
        const double middle = a + (2 * panel + 1) * half;
        for (std::size_t i = 0; i < n; ++i)
            total += half * rule.weights[i] * f(middle + half * rule.nodes[i]);
    }
    return total;
}

} // namespace montelux::bench
