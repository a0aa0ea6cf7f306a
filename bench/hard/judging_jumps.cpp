// Judging families of jumps: dice, solid bodies, ordered variables, saw teeth, checkerboards, histograms.
#include "bench/hard/judging.h"
#include <algorithm>

namespace montelux::bench {

namespace {

HardIntegral dice(Draws& draws) {
    const int n = draws.integer(1, 8), kind = draws.integer(0, 2);
    std::vector<double> law{1}; // of the sum less n
    for (int j = 0; j < n; ++j) {
        std::vector<double> next(law.size() + 5, 0.0);
        for (std::size_t k = 0; k < law.size(); ++k)
            for (std::size_t face = 0; face < 6; ++face) next[k + face] += law[k] / 6;
        law = std::move(next);
    }
    const double above = draws.uniform(-1, 2.5);
    const int least =
        std::clamp(static_cast<int>(3.5 * n + above * std::sqrt(35.0 / 12 * n)), n + 1, 6 * n - 1);
    const int sixes = draws.integer(1, (n + 1) / 2);
    double exact = 0;
    if (kind < 2)
        for (int sum = least; sum <= 6 * n; ++sum) exact += law[sum - n] * (kind == 0 ? 1 : sum - least);
    else
        for (int k = sixes; k <= n; ++k)
            exact += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0)) *
                     std::pow(5.0, n - k) / std::pow(6.0, n);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    int sum = 0, hits = 0;
                    for (int j = 0; j < n; ++j) {
                        const int die = static_cast<int>(6 * x[j]) + 1;
                        sum += die;
                        hits += die >= 6 ? 1 : 0;
                    }
                    if (kind == 2) return hits >= sixes ? 1.0 : 0.0;
                    return sum < least ? 0.0 : kind == 0 ? 1.0 : static_cast<double>(sum - least);
                },
            .exact = exact,
            .parameters = words(n, " dice, ",
                                kind == 0   ? words("sum at least ", least)
                                : kind == 1 ? words("sum above ", least)
                                            : words("sixes at least ", sixes))};
}

// Bodies about the origin, with their volumes and moments of inertia about the third axis.
struct Body {
    int kind;
    double r, q; // radius, and small radius or height

    bool contains(double x, double y, double z) const {
        const double round = x * x + y * y;
        switch (kind) {
        case 0: { // torus
            const double ring = std::sqrt(round) - r;
            return ring * ring + z * z < q * q;
        }
        case 1: { // cone, apex up, from -q to q
            const double radius = r * (q - z) / (2 * q);
            return z > -q && z < q && round < radius * radius;
        }
        case 2: // two crossed cylinders
            return x * x + z * z < r * r && y * y + z * z < r * r;
        default: // hollow ball
            return round + z * z < r * r && round + z * z > q * q;
        }
    }
    double volume() const {
        switch (kind) {
        case 0:
            return 2 * pi * pi * r * q * q;
        case 1:
            return pi * r * r * 2 * q / 3;
        case 2:
            return 16 * r * r * r / 3;
        default:
            return 4 * pi / 3 * (r * r * r - q * q * q);
        }
    }
    double inertia() const {
        switch (kind) {
        case 0:
            return volume() * (r * r + 0.75 * q * q);
        case 1:
            return 0.3 * volume() * r * r;
        case 2:
            return 128 * std::pow(r, 5) / 45;
        default:
            return 8 * pi / 15 * (std::pow(r, 5) - std::pow(q, 5));
        }
    }
    double width() const { return kind == 0 ? r + q : r; }
    double height() const { return kind < 2 ? q : r; }
};

HardIntegral solid_body(Draws& draws) {
    const int kind = draws.integer(0, 3);
    const double r = draws.uniform(0.5, 2), q = r * draws.log_uniform(kind == 3 ? 0.5 : 0.05, 0.95);
    const Body body{kind, r, q};
    const bool inertia = draws.chance(0.5);
    const double margin = draws.chance(0.5) ? 1 : draws.log_uniform(1, 6);
    const std::vector<double> at = draws.uniforms(3, -3, 3);
    std::vector<Range> ranges;
    for (int j = 0; j < 3; ++j) {
        const double half = j < 2 ? body.width() : body.height(), before = draws.uniform();
        ranges.push_back({at[j] - half * (1 + before * 2 * (margin - 1)),
                          at[j] + half * (1 + (1 - before) * 2 * (margin - 1))});
    }
    constexpr const char* kinds[] = {"torus", "cone", "crossed cylinders", "hollow ball"};
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    const double u = x[0] - at[0], v = x[1] - at[1];
                    if (!body.contains(u, v, x[2] - at[2])) return 0.0;
                    return inertia ? u * u + v * v : 1;
                },
            .exact = inertia ? body.inertia() : body.volume(),
            .parameters = words(inertia ? "inertia" : "volume", " of ", kinds[kind], ", ", r, ", ", q,
                                ", box ", margin, " times as wide")};
}

// Indicator of an ellipsoid, or |x - c|^2 inside: tr(A) / (n + 2) times the volume.
HardIntegral ellipsoid(Draws& draws) {
    const int n = draws.integer(2, 6);
    const bool moment = draws.chance(0.5);
    std::vector<double> axis(static_cast<std::size_t>(n));
    const double least = draws.log_uniform(0.1, 1);
    double volume = std::exp(0.5 * n * std::log(pi) - std::lgamma(0.5 * n + 1)), trace = 0, most = 0;
    for (double& a : axis) {
        a = draws.uniform(least, 1);
        volume *= a;
        trace += a * a;
        most = std::max(most, a);
    }
    const auto rows = random_axes(draws, n);
    const double half = most * draws.log_uniform(1, n < 4 ? 3 : 1.3);
    const std::vector<double> centre = draws.uniforms(n, most - half, half - most);
    return {.ranges = box(n, -half, half),
            .f =
                [=](const double* x) {
                    double form = 0;
                    for (int i = 0; i < n; ++i) {
                        double along = 0;
                        for (int j = 0; j < n; ++j) along += rows[i][j] * (x[j] - centre[j]);
                        form += along * along / (axis[i] * axis[i]);
                    }
                    return form >= 1 ? 0 : moment ? distance_squared(x, centre) : 1;
                },
            .exact = moment ? volume * trace / (n + 2) : volume,
            .parameters = words("n = ", n, moment ? ", moment" : ", volume", ", share ",
                                volume / std::pow(2 * half, n), " of the box")};
}

// Product of one function over x_1 < x_2 < ... < x_n: the power of its integral over n!.
HardIntegral time_ordered(Draws& draws) {
    const int n = draws.integer(2, 6);
    const bool wave = draws.chance(0.5);
    const double rate = wave ? draws.uniform(2, 30) : draws.log_uniform(0.1, 30);
    const double phase = draws.uniform(0, 2 * pi), most = draws.log_uniform(0.1, 10);
    const double one = wave ? most * (1 + 0.8 * (std::sin(rate + phase) - std::sin(phase)) / rate)
                            : -most * std::expm1(-rate) / rate;
    return {.ranges = box(n, 0, most),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) {
                        if (j > 0 && x[j] <= x[j - 1]) return 0.0;
                        const double t = rate * x[j] / most;
                        product *= wave ? 1 + 0.8 * std::cos(t + phase) : std::exp(-t);
                    }
                    return product;
                },
            .exact = std::pow(one, n) / std::tgamma(n + 1.0),
            .parameters = words("n = ", n, wave ? ", wave " : ", decay ", rate, ", until ", most)};
}

HardIntegral sawtooth(Draws& draws) {
    const int n = draws.integer(1, 4);
    const bool stairs = draws.chance(0.4);
    // Integrals from 0 to t of t - floor(t).
    auto teeth = [](double t) {
        return 0.5 * std::floor(t) + 0.5 * (t - std::floor(t)) * (t - std::floor(t));
    };
    std::vector<double> k, phase;
    double exact = 1;
    for (int j = 0; j < n; ++j) {
        const double many = draws.log_uniform(2, n == 1 ? 300 : n == 2 ? 40 : 10);
        k.push_back(stairs ? std::round(many) : many);
        phase.push_back(stairs ? draws.uniform(0.5, 2.5) : draws.uniform(0, 1));
        if (!stairs) {
            exact *= (teeth(k[j] + phase[j]) - teeth(phase[j])) / k[j];
            continue;
        }
        double steps = 0;
        for (int i = 1; i < static_cast<int>(k[j]); ++i) steps += 1 - std::pow(i / k[j], 1 / phase[j]);
        exact *= steps / k[j];
    }
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) {
                        const double t = stairs ? k[j] * std::pow(x[j], phase[j]) : k[j] * x[j] + phase[j];
                        product *= stairs ? std::floor(t) / k[j] : t - std::floor(t);
                    }
                    return product;
                },
            .exact = exact,
            .parameters = words("n = ", n, stairs ? ", stairs " : ", teeth ", k[0])};
}

// 1 + c on the white and 1 - c on the black fields.
HardIntegral checkerboard(Draws& draws) {
    const int n = draws.integer(2, 4);
    const double c = draws.uniform(0.2, 1);
    const std::vector<double> k = draws.uniforms(n, 1.5, n == 2 ? 20 : 6), phase = draws.uniforms(n, 0, 2);
    auto folded = [](double t) { // the integral from 0 to t of (-1)^floor(t)
        const double rest = t - 2 * std::floor(t / 2);
        return rest < 1 ? rest : 2 - rest;
    };
    double excess = c;
    for (int j = 0; j < n; ++j) excess *= (folded(k[j] + phase[j]) - folded(phase[j])) / k[j];
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double sign = 1;
                    for (int j = 0; j < n; ++j)
                        if (std::fmod(std::floor(k[j] * x[j] + phase[j]), 2.0) > 0.5) sign = -sign;
                    return 1 + c * sign;
                },
            .exact = 1 + excess,
            .parameters = words("n = ", n, ", contrast ", c, ", first fields ", k[0], ", ", k[1])};
}

HardIntegral histogram(Draws& draws) {
    const int n = draws.integer(1, 3);
    struct Axis {
        std::vector<double> ends, heights;
    };
    std::vector<Axis> axes;
    double exact = 1;
    const double lowest = draws.log_uniform(0.001, 1);
    for (int j = 0; j < n; ++j) {
        const int bins = draws.integer(3, n == 1 ? 60 : 15);
        Axis axis{draws.uniforms(bins, 0, 1), {}};
        std::sort(axis.ends.begin(), axis.ends.end());
        axis.ends.back() = 1;
        double total = 0, previous = 0;
        for (double end : axis.ends) {
            axis.heights.push_back(draws.log_uniform(lowest, 1));
            total += (end - previous) * axis.heights.back();
            previous = end;
        }
        axis.heights.push_back(axis.heights.back()); // at the end itself
        exact *= total;
        axes.push_back(std::move(axis));
    }
    const std::string text = words("n = ", n, ", ", axes[0].ends.size(), " bins, heights from ", lowest);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) {
                        const auto& ends = axes[j].ends;
                        product *=
                            axes[j].heights[std::upper_bound(ends.begin(), ends.end(), x[j]) - ends.begin()];
                    }
                    return product;
                },
            .exact = exact,
            .parameters = text};
}

constexpr HardFamily jump_table[] = {
    {"dice",
     "1..8 dice floor(6 x_j) + 1: indicator of a large sum, what it exceeds, or indicator of many sixes, "
     "over the unit cube. Exact: convolution",
     dice},
    {"solid_body",
     "volume or moment of inertia of a torus, a cone, two crossed cylinders or a hollow ball in a box 1..6 "
     "times as wide, its place in the box random. Exact: closed forms",
     solid_body},
    {"ellipsoid",
     "1 or |x - c|^2 inside an ellipsoid of random axes, half axes from log-uniform 0.1..1 to 1, in a box to "
     "3 (n = 2, 3) or 1.3 times as wide; n in 2..6. Exact: gamma functions",
     ellipsoid},
    {"time_ordered",
     "prod exp(-a x_j) or prod 1 + 0.8 cos(a x_j + p) where x_1 < ... < x_n, over [0, T]^n; n in 2..6, a T "
     "in "
     "0.1..30. Exact: powers over n!",
     time_ordered},
    {"sawtooth",
     "products of the fractions of k x + p, or of floor(k x^g) / k, g in 0.5..2.5, over the unit cube; n in "
     "1..4; k log-uniform in 2..300 (n = 1), 2..40 (2), 2..10. Exact: sums over the steps",
     sawtooth},
    {"checkerboard",
     "1 + c (-1)^(sum floor(k_j x_j + p_j)) over the unit cube; n in 2..4, c in 0.2..1, k in 1.5..20 (n = 2) "
     "or 1.5..6. Exact: product of folded lines",
     checkerboard},
    {"histogram",
     "products of step functions with 3..60 (n = 1) or 3..15 bins of random ends, heights log-uniform from "
     "0.001..1 to 1, over the unit cube; n in 1..3. Exact: sums",
     histogram},
};

} // namespace

std::span<const HardFamily> judging_jump_families() { return jump_table; }

} // namespace montelux::bench
