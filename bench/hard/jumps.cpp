// Families of jumps and of rare events.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"
#include <limits>

#include "montelux/mc/math/special.h"

namespace montelux::bench {

namespace {

HardIntegral jump_on_sphere(Draws& draws) {
    const int n = draws.integer(2, 6), profile = draws.integer(0, 2);
    const double radius = draws.uniform(0.2, 0.45), outside = draws.chance(0.5) ? 0 : draws.uniform(0, 0.5);
    const std::vector<double> centre = draws.uniforms(n, radius, 1 - radius);
    auto inside = [=](double square) {
        return profile == 0 ? 1 : profile == 1 ? std::exp(-2 * square) : 1 + 3 * square;
    };
    const double ball = radial_integral(n, 0, radius, 4, [](double) { return 1; });
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    const double square = distance_squared(x, centre);
                    return square < radius * radius ? inside(square) : outside;
                },
            .exact = radial_integral(n, 0, radius, 4, [&](double r) { return inside(r * r); }) +
                     outside * (1 - ball),
            .parameters =
                words("n = ", n, ", radius ", radius, ", profile ", profile, ", outside ", outside)};
}

// Volume of a.x < t in the unit cube: sum over its corners v of (-1)^|v| (t - a.v)_+^n / (n! prod a), in 113
// bits.
double volume_below_plane(const std::vector<double>& a, double t) {
    const auto n = static_cast<int>(a.size());
    __float128 sum = 0, divisor = 1;
    for (int j = 0; j < n; ++j) divisor *= static_cast<__float128>(a[j]) * (j + 1);
    for (unsigned v = 0; v < (1u << n); ++v) {
        __float128 rest = t, power = 1;
        for (int j = 0; j < n; ++j)
            if (v >> j & 1) rest -= static_cast<__float128>(a[j]);
        if (rest <= 0) continue;
        for (int j = 0; j < n; ++j) power *= rest;
        sum += __builtin_popcount(v) % 2 == 0 ? power : -power;
    }
    return static_cast<double>(sum / divisor);
}

HardIntegral jump_on_plane(Draws& draws) {
    const int n = draws.integer(2, 8);
    std::vector<double> a(static_cast<std::size_t>(n), 1.0);
    if (draws.chance(0.7)) a = draws.uniforms(n, 0.3, 1);
    double sum = 0;
    for (double a_j : a) sum += a_j;
    const double t = sum * draws.uniform(0.3, 0.7), outside = draws.chance(0.5) ? 0 : draws.uniform(0, 0.5);
    const double below = volume_below_plane(a, t);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double total = 0;
                    for (int j = 0; j < n; ++j) total += a[j] * x[j];
                    return total < t ? 1 : outside;
                },
            .exact = below + outside * (1 - below),
            .parameters = words("n = ", n, ", sum below ", t / sum, " of its range, outside ", outside)};
}

// A region of probability p in the unit cube.
struct Region {
    int n;
    double p;
    bool corner;
    std::vector<double> from, to; // of the box
    double threshold;             // of the sum of normal variables, over sqrt(n)

    explicit Region(Draws& draws)
        : n(draws.integer(1, 6)), p(draws.log_uniform(1e-9, 1e-2)), corner(draws.chance(0.5)) {
        const bool at_corner = draws.chance(0.5);
        const double side = std::pow(p, 1.0 / n);
        for (int j = 0; j < n; ++j) {
            const double begin = at_corner ? (draws.chance(0.5) ? 0 : 1 - side) : draws.uniform(0, 1 - side);
            from.push_back(begin);
            to.push_back(begin + side);
        }
        if (!corner) p = normal_cdf(-(threshold = -normal_quantile(p)));
        if (corner) {
            p = 1;
            for (int j = 0; j < n; ++j) p *= to[j] - from[j];
        }
    }
    bool contains(const double* x) const {
        if (!corner) {
            double total = 0;
            for (int j = 0; j < n; ++j) total += normal_quantile(x[j]);
            return total > threshold * std::sqrt(static_cast<double>(n));
        }
        for (int j = 0; j < n; ++j)
            if (x[j] < from[j] || x[j] > to[j]) return false;
        return true;
    }
    std::string text() const {
        return words("n = ", n, ", p = ", p, corner ? ", box" : ", sum of normal variables");
    }
};

HardIntegral rare_event(Draws& draws) {
    const Region region(draws);
    // Over all of space with the normal density, in a third of the cases of sums.
    if (!region.corner && region.n <= 4 && draws.chance(0.33)) {
        const double infinity = std::numeric_limits<double>::infinity();
        return {.ranges = box(region.n, -infinity, infinity),
                .f =
                    [region](const double* x) {
                        double total = 0, square = 0;
                        for (int j = 0; j < region.n; ++j) {
                            total += x[j];
                            square += x[j] * x[j];
                        }
                        if (!(total > region.threshold * std::sqrt(static_cast<double>(region.n))))
                            return 0.0;
                        return std::exp(-0.5 * square) * std::pow(2 * pi_, -0.5 * region.n);
                    },
                .exact = region.p,
                .parameters = region.text() + " over space"};
    }
    return {.ranges = box(region.n, 0, 1),
            .f = [region](const double* x) { return region.contains(x) ? 1 : 0; },
            .exact = region.p,
            .parameters = region.text()};
}

HardIntegral rare_complement(Draws& draws) {
    const Region region(draws);
    return {.ranges = box(region.n, 0, 1),
            .f = [region](const double* x) { return region.contains(x) ? 0 : 1; },
            .exact = 1 - region.p,
            .parameters = region.text()};
}

constexpr HardFamily families[] = {
    {"jump_sphere",
     "1, exp(-2 r^2) or 1 + 3 r^2 inside a ball, r from its centre, a constant outside, over the unit cube; "
     "n "
     "in 2..6, radius 0.2..0.45. Exact: radial Gauss panels",
     jump_on_sphere},
    {"jump_plane",
     "1 where a.x < t, else a constant, over the unit cube; n in 2..8, a_j = 1 or in 0.3..1. Exact: the sum "
     "over the corners of the cube (Irwin-Hall), in 113 bits",
     jump_on_plane},
    {"rare_event",
     "indicator of a region of probability p over the unit cube: a box, or a sum of normal quantiles above a "
     "threshold (also over space with the normal density); n in 1..6, p log-uniform in 1e-9..1e-2. Exact: p",
     rare_event},
    {"rare_complement", "1 - the indicator of such a region. Exact: 1 - p", rare_complement},
};

} // namespace

std::span<const HardFamily> jump_families() { return families; }

} // namespace montelux::bench
