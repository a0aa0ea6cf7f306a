// Judging families of singularities and kinks: inside, at corners, at both ends, and of pairs of points.
#include "bench/hard/judging.h"

namespace montelux::bench {

namespace {

HardIntegral interior_powers(Draws& draws) {
    const int n = draws.integer(1, 3);
    std::vector<double> at = draws.uniforms(n, 0.05, 0.95), power;
    double exact = 1;
    for (int j = 0; j < n; ++j) {
        const double c = at[j], p = draws.chance(0.3) ? 0 : draws.uniform(0.3, n == 1 ? 0.7 : 0.6);
        power.push_back(p); // 0 for the logarithm
        exact *= p > 0 ? (std::pow(c, 1 - p) + std::pow(1 - c, 1 - p)) / (1 - p)
                       : 1 - c * std::log(c) - (1 - c) * std::log1p(-c);
    }
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) {
                        const double r = std::abs(x[j] - at[j]);
                        product *= power[j] > 0 ? std::pow(r, -power[j]) : -std::log(r);
                    }
                    return product;
                },
            .exact = exact,
            .parameters = words("n = ", n, ", first power ", power[0], " at ", at[0])};
}

// r^-p has the divergence theorem's integral over the faces, h r^-p / (n - p), h from the centre.
HardIntegral distance_power(Draws& draws) {
    const int n = draws.integer(2, 3);
    const bool corner = draws.chance(0.4);
    const double p = n * draws.uniform(0.25, 0.85);
    std::vector<double> centre(static_cast<std::size_t>(n), 0.0);
    if (!corner) centre = draws.uniforms(n, 0.15, 0.85);
    double exact = 0;
    for (int j = 0; j < n; ++j)
        for (double h : {centre[j], 1 - centre[j]}) {
            if (h == 0) continue;
            const double second = centre[(j + 1) % n], third = centre[(j + 2) % n];
            exact += h * integrate_by_panels(-second, 1 - second, 12, [&](double u) {
                         if (n == 2) return std::pow(h * h + u * u, -p / 2);
                         return integrate_by_panels(-third, 1 - third, 12, [&](double v) {
                             return std::pow(h * h + u * u + v * v, -p / 2);
                         });
                     });
        }
    return {.ranges = box(n, 0, 1),
            .f = [=](const double* x) { return std::pow(distance_squared(x, centre), -p / 2); },
            .exact = exact / (n - p),
            .parameters = words("n = ", n, ", r^-", p, corner ? " at a corner" : " inside"),
            .accuracy = 1e-11};
}

HardIntegral both_ends(Draws& draws) {
    const int n = draws.integer(1, 3);
    const bool arcs = draws.chance(0.3);
    std::vector<double> p, q;
    std::vector<Range> ranges;
    double exact = 1;
    for (int j = 0; j < n; ++j) {
        const double from = draws.uniform(-3, 3), length = draws.log_uniform(0.2, 5);
        ranges.push_back({from, from + length});
        p.push_back(arcs ? 0.5 : draws.uniform(0.4, 1.2));
        q.push_back(arcs ? 0.5 : draws.uniform(0.4, 1.2));
        exact *= std::exp(std::lgamma(p[j]) + std::lgamma(q[j]) - std::lgamma(p[j] + q[j]));
    }
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) {
                        const double length = ranges[j].upper - ranges[j].lower;
                        product *= std::pow((x[j] - ranges[j].lower) / length, p[j] - 1) *
                                   std::pow((ranges[j].upper - x[j]) / length, q[j] - 1) / length;
                    }
                    return product;
                },
            .exact = exact,
            .parameters =
                words("n = ", n, ", first powers ", p[0] - 1, ", ", q[0] - 1, " from ", ranges[0].lower)};
}

// Integral over the unit cube of max(0, t - a.x)^q, q = 1 or 2: the sum over its corners v of
// (-1)^|v| (t - a.v)_+^(n + q) q! / ((n + q)! prod a), in 113 bits.
double power_below_plane(const std::vector<double>& a, double t, int q) {
    const auto n = static_cast<int>(a.size());
    __float128 sum = 0, divisor = 1;
    for (int j = 0; j < n; ++j) divisor *= static_cast<__float128>(a[j]) * (q + 1 + j);
    for (unsigned v = 0; v < (1u << n); ++v) {
        __float128 rest = t, power = 1;
        for (int j = 0; j < n; ++j)
            if (v >> j & 1) rest -= static_cast<__float128>(a[j]);
        if (rest <= 0) continue;
        for (int j = 0; j < n + q; ++j) power *= rest;
        sum += __builtin_popcount(v) % 2 == 0 ? power : -power;
    }
    return static_cast<double>(sum / divisor);
}

HardIntegral hinge(Draws& draws) {
    const int n = draws.integer(2, 8), kind = draws.integer(0, 2); // excess, its square, distance
    const std::vector<double> a = draws.uniforms(n, 0.2, 1);
    double sum = 0;
    for (double a_j : a) sum += a_j;
    const double t = sum * (kind == 2 ? draws.uniform(0.3, 0.7) : draws.uniform(0.5, 0.9));
    // max(0, a.x - t) by reflection of the cube.
    const double above = power_below_plane(a, sum - t, kind == 1 ? 2 : 1);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double excess = -t;
                    for (int j = 0; j < n; ++j) excess += a[j] * x[j];
                    if (kind == 2) return std::abs(excess);
                    return excess <= 0 ? 0.0 : kind == 1 ? excess * excess : excess;
                },
            .exact = kind == 2 ? above + power_below_plane(a, t, 1) : above,
            .parameters = words("n = ", n,
                                kind == 2   ? ", distance from "
                                : kind == 1 ? ", square above "
                                            : ", excess above ",
                                t / sum, " of the range"),
            .accuracy = 1e-10};
}

// Two points of a box of d dimensions, a function of their distance: r, 1 / r, exp(-r / l) / r. With u the
// absolute differences the integral is 2^d prod(a_j - u_j) g(|u|); u = s w, w on a far face of the box.
HardIntegral pair_distance(Draws& draws) {
    const int d = draws.integer(2, 3), kind = draws.integer(0, 2);
    const std::vector<double> side = draws.uniforms(d, 0.5, 2);
    const double range = draws.log_uniform(0.05, 2);
    auto g = [=](double r) { return kind == 0 ? r : kind == 1 ? 1 / r : std::exp(-r / range) / r; };
    double exact = 0;
    for (int face = 0; face < d; ++face) {
        const int second = (face + 1) % d, third = (face + 2) % d;
        double w[3] = {0, 0, 0};
        w[face] = side[face];
        auto along = [&] {
            double square = 0;
            for (int j = 0; j < d; ++j) square += w[j] * w[j];
            const double r = std::sqrt(square);
            return side[face] * integrate_by_panels(0, 1, 8, [&](double s) {
                       double product = d == 2 ? s : s * s;
                       for (int j = 0; j < d; ++j) product *= 2 * (side[j] - s * w[j]);
                       return product * g(s * r);
                   });
        };
        exact += integrate_by_panels(0, side[second], 3, [&](double v) {
            w[second] = v;
            if (d == 2) return along();
            return integrate_by_panels(0, side[third], 3, [&](double last) {
                w[third] = last;
                return along();
            });
        });
    }
    std::vector<Range> ranges;
    for (int point = 0; point < 2; ++point)
        for (double a : side) ranges.push_back({0, a});
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    double square = 0;
                    for (int j = 0; j < d; ++j) square += (x[j] - x[j + d]) * (x[j] - x[j + d]);
                    return g(std::sqrt(square));
                },
            .exact = exact,
            .parameters = words("n = ", 2 * d, ", first side ", side[0],
                                kind == 0   ? ", r"
                                : kind == 1 ? ", 1 / r"
                                            : words(", Yukawa of range ", range)),
            .accuracy = 1e-10};
}

constexpr HardFamily singular_table[] = {
    {"interior_powers",
     "products of |x_j - c_j|^-p, p in 0.3..0.7 (n = 1) or 0.3..0.6, and -log |x_j - c_j|, c in 0.05..0.95, "
     "over the unit cube; n in 1..3. Exact: antiderivatives",
     interior_powers},
    {"distance_power",
     "|x - c|^-p over the unit cube, c a corner or inside; n in 2, 3, p / n in 0.25..0.85. Exact: Gauss "
     "panels over the faces, by the divergence theorem",
     distance_power},
    {"both_ends",
     "products of beta densities without their constants, carried to [a, b], powers -0.6..0.2 at both ends "
     "or all -1/2; n in 1..3. Exact: beta function",
     both_ends},
    {"hinge",
     "max(0, a.x - t), its square, or |a.x - t|, over the unit cube; n in 2..8, a_j in 0.2..1. Exact: sum "
     "over the corners of the cube, in 113 bits",
     hinge},
    {"pair_distance",
     "r, 1 / r or exp(-r / l) / r of two points of a rectangle or a cuboid, l log-uniform in 0.05..2; n = 4, "
     "6. Exact: Gauss panels over the differences, in pyramids",
     pair_distance},
};

} // namespace

std::span<const HardFamily> judging_singular_families() { return singular_table; }

} // namespace montelux::bench
