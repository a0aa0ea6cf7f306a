// Judging families of physics: wave packets, diffraction, fringes, spins, chains, random walks, scattering.
#include "bench/hard/judging.h"
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <utility>

#include "montelux/mc/math/special.h"

namespace montelux::bench {

namespace {

HardIntegral wave_packet(Draws& draws) {
    if (draws.chance(0.3)) { // exp(-g t) sin(w t)
        const double g = draws.log_uniform(0.1, 10), w = g * draws.log_uniform(2, 100);
        return {.ranges = box(1, 0, draws.chance(0.5) ? infinity : 40 / g),
                .f = [=](const double* x) { return std::exp(-g * x[0]) * std::sin(w * x[0]); },
                .exact = w / (g * g + w * w),
                .parameters = words("damped, rate ", g, ", frequency ", w)};
    }
    const int n = draws.integer(1, 4);
    const bool whole = draws.chance(0.3);
    const double norm = draws.uniform(0.5, 3.5), phase = draws.uniform(-pi / 4, pi / 4);
    std::vector<double> direction = draws.uniforms(n, -1, 1), s;
    double square = 0, exact = std::cos(phase) * std::exp(-0.5 * norm * norm);
    for (double k : direction) square += k * k;
    std::vector<Range> ranges;
    const std::vector<double> centre = draws.uniforms(n, -1, 1);
    for (int j = 0; j < n; ++j) {
        s.push_back(draws.log_uniform(0.1, 3));
        exact *= std::sqrt(2 * pi) * s[j];
        direction[j] *= norm / std::sqrt(square);
        const double half = s[j] * draws.uniform(9, 20);
        ranges.push_back(whole ? Range{-infinity, infinity} : Range{centre[j] - half, centre[j] + half});
    }
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    double exponent = 0, angle = phase;
                    for (int j = 0; j < n; ++j) {
                        const double t = (x[j] - centre[j]) / s[j];
                        exponent += t * t;
                        angle += direction[j] * t;
                    }
                    return std::exp(-0.5 * exponent) * std::cos(angle);
                },
            .exact = exact,
            .parameters = words("n = ", n, ", k s = ", norm, whole ? ", over space" : ""),
            .accuracy = 1e-11};
}

HardIntegral diffraction(Draws& draws) {
    const int kind = draws.integer(0, 3);
    if (kind == 0) { // Airy's disc: light within a radius
        const double radius = draws.log_uniform(10, 1000);
        return {.ranges = box(1, 0, radius),
                .f =
                    [=](const double* x) {
                        return x[0] > 0 ? 4 * std::pow(boost::math::cyl_bessel_j(1, x[0]), 2) / x[0] : 0;
                    },
                .exact = 2 * (1 - std::pow(boost::math::cyl_bessel_j(0, radius), 2) -
                              std::pow(boost::math::cyl_bessel_j(1, radius), 2)),
                .parameters = words("Airy's disc to ", radius)};
    }
    if (kind == 1) { // exp(-a x) J_0(k x)
        const double a = draws.log_uniform(0.1, 10), k = a * draws.log_uniform(1, 50);
        return {.ranges = box(1, 0, draws.chance(0.5) ? infinity : 40 / a),
                .f =
                    [=](const double* x) {
                        const double fall = std::exp(-a * x[0]);
                        return fall > 0 ? fall * boost::math::cyl_bessel_j(0, k * x[0]) : 0;
                    },
                .exact = 1 / std::sqrt(a * a + k * k),
                .parameters = words("exp(-", a, " x) J_0(", k, " x)")};
    }
    const int n = draws.integer(1, kind == 2 ? 3 : 2);
    std::vector<Range> ranges;
    double exact = 1;
    if (kind == 2) { // slits: (sin x / x)^2
        for (int j = 0; j < n; ++j) {
            const double from = -draws.log_uniform(3, n == 1 ? 1000 : 60), to = draws.log_uniform(3, 60);
            ranges.push_back({from, to});
            auto integral = [](double t) { return sine_integral(2 * t) - std::pow(std::sin(t), 2) / t; };
            exact *= integral(to) + integral(-from);
        }
        return {.ranges = ranges,
                .f =
                    [=](const double* x) {
                        double product = 1;
                        for (int j = 0; j < n; ++j)
                            product *= x[j] == 0 ? 1 : std::pow(std::sin(x[j]) / x[j], 2);
                        return product;
                    },
                .exact = exact,
                .parameters =
                    words("n = ", n, ", slits, first from ", ranges[0].lower, " to ", ranges[0].upper)};
    }
    // Gratings: (sin m x / sin x)^2 / m over one period.
    std::vector<double> lines;
    for (int j = 0; j < n; ++j) {
        lines.push_back(std::round(draws.log_uniform(3, n == 1 ? 500 : 50)));
        const double from = draws.chance(0.5) ? 0 : draws.uniform(-3, 0);
        ranges.push_back({from, from + pi});
        exact *= pi;
    }
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) {
                        const double sine = std::sin(x[j]), m = lines[j];
                        product *= std::abs(sine) < 1e-12 ? m : std::pow(std::sin(m * x[j]) / sine, 2) / m;
                    }
                    return product;
                },
            .exact = exact,
            .parameters = words("n = ", n, ", grating of ", lines[0], " lines from ", ranges[0].lower)};
}

HardIntegral fringes(Draws& draws) {
    if (draws.chance(0.3)) { // 1 + v cos(k x y)
        const double k = draws.log_uniform(5, 2000), v = draws.uniform(0.3, 1);
        return {.ranges = box(2, 0, 1),
                .f = [=](const double* x) { return 1 + v * std::cos(k * x[0] * x[1]); },
                .exact = 1 + v * sine_integral(k) / k,
                .parameters = words("n = 2, ", k, " x y, contrast ", v)};
    }
    const int n = draws.integer(1, 4);
    const bool exactly = draws.chance(0.4);
    const double v = draws.uniform(0.3, 1), most = n == 1 ? 1024 : n == 2 ? 128 : 32;
    std::vector<double> k;
    const std::vector<double> phase = draws.uniforms(n, 0, 2 * pi);
    double exact = 1;
    for (int j = 0; j < n; ++j) {
        const double frequency = draws.log_uniform(1.5, most);
        k.push_back(2 * pi * (exactly ? std::exp2(std::round(std::log2(frequency))) : frequency));
        if (!exactly) exact *= 1 + v * (std::sin(k[j] + phase[j]) - std::sin(phase[j])) / k[j];
    }
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) product *= 1 + v * std::cos(k[j] * x[j] + phase[j]);
                    return product;
                },
            .exact = exact,
            .parameters = words("n = ", n, ", contrast ", v, ", first periods ", k[0] / (2 * pi))};
}

// Spins in a plane, neighbours coupled; an open chain or a ring.
HardIntegral spin_chain(Draws& draws) {
    const int n = draws.integer(2, 8);
    const bool ring = n > 2 && draws.chance(0.5);
    const double k = draws.log_uniform(0.3, n <= 3 ? 30 : 8);
    const int links = ring ? n : n - 1;
    auto factor = [&](int m) { return 2 * pi * std::exp(-k) * boost::math::cyl_bessel_i(std::abs(m), k); };
    double exact = 0;
    if (ring)
        for (int m = -60; m <= 60; ++m) exact += std::pow(factor(m), n);
    else
        exact = 2 * pi * std::pow(factor(0), links);
    return {.ranges = box(n, 0, 2 * pi),
            .f =
                [=](const double* x) {
                    double energy = 0;
                    for (int j = 0; j < links; ++j) energy += std::cos(x[j] - x[(j + 1) % n]) - 1;
                    return std::exp(k * energy);
                },
            .exact = exact,
            .parameters = words("n = ", n, ring ? ", ring" : ", open", ", coupling ", k)};
}

// Curie and Weiss: all spins of [-1, 1] coupled to their mean; Hubbard and Stratonovich's variable makes
// them independent.
HardIntegral mean_field(Draws& draws) {
    const int n = draws.integer(3, 12);
    const double coupling = draws.log_uniform(0.5, 10);
    const double most = coupling + 12 * std::sqrt(coupling / n);
    const double exact = 2 * integrate_by_panels(0, most, 100, [&](double z) {
                             // sinh(z) / z as exp(z) (1 - exp(-2 z)) / (2 z).
                             return std::exp(n * (z + std::log(-std::expm1(-2 * z) / z) -
                                                  z * z / (2 * coupling) - coupling / 2));
                         });
    return {.ranges = box(n, -1, 1),
            .f =
                [=](const double* x) {
                    double sum = 0;
                    for (int j = 0; j < n; ++j) sum += x[j];
                    return std::exp(coupling / 2 * (sum * sum / n - n));
                },
            .exact = std::sqrt(n / (2 * pi * coupling)) * exact,
            .parameters = words("n = ", n, ", coupling ", coupling),
            .accuracy = 1e-11};
}

// Path of a particle in two wells, exp(-sum a (x_j^2 - 1)^2 + k (x_j - x_j+1)^2 / 2): transfer matrix.
HardIntegral double_well(Draws& draws) {
    const int n = draws.integer(2, 8);
    const double a = draws.log_uniform(0.3, 6), k = draws.log_uniform(0.3, 20), half = 3;
    const bool closed = n > 2 && draws.chance(0.3);
    constexpr int panels = 8;
    std::vector<double> at, weight;
    const auto& rule = GaussLegendre<20>::rule();
    integrate_by_panels(-half, half, panels, [&](double x) {
        weight.push_back(half / panels * rule.weights[at.size() % 20] *
                         std::exp(-a * (x * x - 1) * (x * x - 1)));
        at.push_back(x);
        return 0;
    });
    const std::size_t size = at.size();
    std::vector<std::vector<double>> link(size, std::vector<double>(size));
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j < size; ++j)
            link[i][j] = std::exp(-0.5 * k * (at[i] - at[j]) * (at[i] - at[j]));
    double exact = 0;
    for (std::size_t start = 0; start < (closed ? size : 1); ++start) {
        std::vector<double> row(size, 1.0); // over what comes after, from the last point backwards
        for (std::size_t i = 0; i < size && closed; ++i) row[i] = link[i][start];
        for (int step = 1; step < n; ++step) {
            std::vector<double> next(size, 0.0);
            for (std::size_t i = 0; i < size; ++i)
                for (std::size_t j = 0; j < size; ++j) next[i] += link[i][j] * weight[j] * row[j];
            row = std::move(next);
        }
        if (closed)
            exact += weight[start] * row[start];
        else
            for (std::size_t i = 0; i < size; ++i) exact += weight[i] * row[i];
    }
    return {.ranges = box(n, -half, half),
            .f =
                [=](const double* x) {
                    double action = 0;
                    for (int j = 0; j < n; ++j) {
                        const double well = x[j] * x[j] - 1;
                        action += a * well * well;
                        if (j + 1 == n && !closed) break;
                        const double stretch = x[j] - x[(j + 1) % n];
                        action += 0.5 * k * stretch * stretch;
                    }
                    return std::exp(-action);
                },
            .exact = exact,
            .parameters = words("n = ", n, closed ? ", ring" : ", open", ", well ", a, ", spring ", k)};
}

// exp(-x) I_0(x).
double scaled_bessel(double x) {
    if (x < 50) return std::exp(-x) * boost::math::cyl_bessel_i(0, x);
    double term = 1, sum = 1;
    for (int k = 1; k < 20; ++k) sum += term *= (2 * k - 1.0) * (2 * k - 1.0) / (8 * k * x);
    return sum / std::sqrt(2 * pi * x);
}

// Returns of random walks: simple lattices in 4..6 dimensions, body-centred ones in 2 and 3, where the sum
// over walks of weights z^steps is 2 / pi K(z), and (2 / pi K(k))^2 with k^2 = (1 - sqrt(1 - z^2)) / 2.
HardIntegral random_walk(Draws& draws) {
    const bool simple = draws.chance(0.4);
    const int d = simple ? draws.integer(4, 6) : draws.integer(2, 3);
    const double gap = simple || (d == 3 && draws.chance(0.3)) ? 0 : draws.log_uniform(1e-6, 0.3);
    const std::vector<double> shift = draws.uniforms(d, -pi, pi);
    const bool at_corner = draws.chance(0.5);
    double mean;
    if (simple) {
        mean = integrate_by_panels(-40, 60, 200, [&](double s) {
            const double t = std::exp(s);
            return t * std::pow(scaled_bessel(t / d), d);
        });
    } else if (d == 2) { // K of the modulus z, which is near 1, by its complement
        double a = 1, g = std::sqrt(gap * (2 - gap));
        for (int step = 0; step < 12; ++step) {
            const double next = 0.5 * (a + g);
            g = std::sqrt(a * g);
            a = next;
        }
        mean = 1 / a;
    } else {
        const double k = std::sqrt((1 - std::sqrt(gap * (2 - gap))) / 2);
        mean = std::pow(2 / pi * boost::math::ellint_1(k), 2);
    }
    return {.ranges = at_corner ? box(d, 0, pi) : box(d, 0, 2 * pi),
            .f =
                [=](const double* x) {
                    double sum = 0, rest = 0; // 1 - product of cosines, without cancellation
                    for (int j = 0; j < d; ++j) {
                        const double angle = at_corner ? x[j] : x[j] + shift[j], sine = std::sin(angle / 2);
                        const double less = 2 * sine * sine;
                        sum += less / d;
                        rest += less - rest * less;
                    }
                    return simple ? 1 / sum : 1 / (gap + (1 - gap) * rest);
                },
            .exact = mean * std::pow(at_corner ? pi : 2 * pi, d),
            .parameters = words("n = ", d, simple ? ", simple" : words(", body-centred, 1 - z = ", gap),
                                at_corner ? ", corner" : words(", inside, first shift ", shift[0])),
            .accuracy = simple ? 1e-10 : 1e-11};
}

// Screened Rutherford scattering, 1..2 collisions: sin t / (sin^2(t / 2) + e)^2, with exchange or without,
// and 1 + b cos 2 p.
HardIntegral scattering(Draws& draws) {
    const int collisions = draws.integer(1, 2);
    const bool exchange = draws.chance(0.4);
    const double b = draws.uniform(-0.9, 0.9);
    std::vector<double> screening;
    double exact = 1;
    for (int j = 0; j < collisions; ++j) {
        const double e = draws.log_uniform(collisions == 1 ? 1e-7 : 1e-4, 0.1);
        screening.push_back(e);
        exact *= 2 * pi * 2 / (1 + e) * (exchange ? 2 : 1);
    }
    std::vector<Range> ranges;
    for (int j = 0; j < collisions; ++j) {
        ranges.push_back({0, pi});
        ranges.push_back({0, 2 * pi});
    }
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < collisions; ++j) {
                        const double sine = std::sin(x[2 * j] / 2), cosine = std::cos(x[2 * j] / 2);
                        const double e = screening[j], t = sine * sine + e, u = cosine * cosine + e;
                        product *= e * std::sin(x[2 * j]) * (1 / (t * t) + (exchange ? 1 / (u * u) : 0)) *
                                   (1 + b * std::cos(2 * x[2 * j + 1]));
                    }
                    return product;
                },
            .exact = exact,
            .parameters = words("n = ", 2 * collisions, ", screening ", screening[0],
                                exchange ? ", with exchange" : "")};
}

constexpr HardFamily physics_table[] = {
    {"wave_packet",
     "Gaussian packets of widths 0.1..3 times a cosine, wave number 0.5..3.5 over the width, over a box of "
     "9..20 widths or space, n in 1..4; exp(-g t) sin(w t), w / g in 2..100. Exact: Fourier transforms",
     wave_packet},
    {"diffraction",
     "Airy's disc, slits (sin x / x)^2 in 1..3 variables, gratings of 3..500 lines in 1 or 2, exp(-a x) "
     "J_0(k x). Exact: Bessel functions, sine integral, pi",
     diffraction},
    {"fringes",
     "prod 1 + v cos(2 pi k_j x_j + p_j), k log-uniform from 1.5 to 1024 (n = 1), 128 (2), 32 (3, 4), or "
     "powers of 2; 1 + v cos(k x y); v in 0.3..1, over the unit cube. Exact: sines, sine integral",
     fringes},
    {"spin_chain",
     "exp(K sum cos(x_j - x_j+1) - 1) over [0, 2 pi]^n, open or a ring; n in 2..8, K log-uniform in 0.3..30 "
     "(n = 2, 3) or 0.3..8. Exact: Bessel functions",
     spin_chain},
    {"mean_field",
     "exp(J / 2 ((sum x_j)^2 / n - n)) over [-1, 1]^n; n in 3..12, J log-uniform in 0.5..10. Exact: Gauss "
     "panels over the field of Hubbard and Stratonovich",
     mean_field},
    {"double_well",
     "exp(-sum a (x_j^2 - 1)^2 + k (x_j - x_j+1)^2 / 2) over [-3, 3]^n, open or a ring; n in 2..8, a "
     "log-uniform in 0.3..6, k in 0.3..20. Exact: transfer matrix on Gauss panels",
     double_well},
    {"random_walk",
     "d / sum(1 - cos x_j), d in 4..6; 1 / (1 - z prod cos x_j), d in 2, 3, 1 - z log-uniform in 1e-6..0.3 "
     "or 0 (3); over [0, pi]^d, or [0, 2 pi]^d with the poles inside. Exact: Bessel functions, elliptic "
     "integrals",
     random_walk},
    {"scattering",
     "screened Rutherford angles of 1 or 2 collisions, e sin t / (sin^2(t / 2) + e)^2, with exchange or "
     "without, times 1 + b cos 2 p; e log-uniform from 1e-7 (1) or 1e-4 (2) to 0.1. Exact: closed form",
     scattering},
};

} // namespace

std::span<const HardFamily> judging_physics_families() { return physics_table; }

} // namespace montelux::bench
