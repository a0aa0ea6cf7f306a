#include "bench/integrate/integrands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux::bench {

namespace {

using enum Family;

constexpr Line lines[] = {
    {oscillatory, 2},   {product_peak, 2},  {corner_peak, 2},   {gaussian, 2},     {continuous, 2},
    {discontinuous, 2}, {oscillatory, 5},   {product_peak, 5},  {corner_peak, 5},  {gaussian, 5},
    {continuous, 5},    {discontinuous, 5}, {oscillatory, 8},   {product_peak, 8}, {corner_peak, 8},
    {gaussian, 8},      {continuous, 8},    {discontinuous, 8}, {sine, 1},         {exponential, 1},
    {quadratic, 1},     {inverse_root, 1},  {jump, 1},          {two_peaks, 4},    {three_peaks, 8},
    {four_peaks, 8},    {ridge, 4},         {ridge, 8},
};

constexpr Line line_of_costs{sum, 8};

struct FamilyFacts {
    const char* name;
    double difficulty; // sum of the c_j
};
constexpr FamilyFacts facts[] = {
    {"osc", 6.0},  {"prod", 18.0}, {"corner", 2.2},  {"gauss", 15.2}, {"c0", 16.1}, {"disc", 16.4},
    {"sin", 0},    {"exp", 0},     {"quadratic", 0}, {"rsqrt", 0},    {"jump", 0},  {"peaks2", 0},
    {"peaks3", 0}, {"peaks4", 0},  {"ridge", 0},     {"sum", 0},
};
const FamilyFacts& facts_of(Family family) { return facts[static_cast<int>(family)]; }

// Adds up term(j, x_j) over the coordinates of each point, then applies `last`.
template <typename Term, typename Last>
void sum_over_coordinates(const double* const* x, int dimensions, std::size_t n, double* values,
                          const Term& term, const Last& last) {
    std::fill_n(values, n, 0.0);
    for (int j = 0; j < dimensions; ++j) {
        const double* column = x[j];
        for (std::size_t i = 0; i < n; ++i) values[i] += term(j, column[i]);
    }
    for (std::size_t i = 0; i < n; ++i) values[i] = last(values[i]);
}
template <typename Term, typename Last>
double sum_over_coordinates(const double* x, int dimensions, const Term& term, const Last& last) {
    double sum = 0;
    for (int j = 0; j < dimensions; ++j) sum += term(j, x[j]);
    return last(sum);
}

// base^-(d + 1) by multiplication.
double corner(double base, int dimensions) {
    double power = base;
    for (int j = 0; j < dimensions; ++j) power *= base;
    return 1 / power;
}

} // namespace

std::span<const Line> bench_lines() { return lines; }

std::string line_name(Line line) {
    std::string name = facts_of(line.family).name;
    if (line_group(line) == Group::one_dimensional) return name;
    return name + "-" + std::to_string(line.dimensions);
}

std::optional<Line> line_named(std::string_view name) {
    for (Line line : lines)
        if (line_name(line) == name) return line;
    if (name == line_name(line_of_costs)) return line_of_costs;
    return std::nullopt;
}

Group line_group(Line line) {
    switch (line.family) {
    case discontinuous:
        return Group::discontinuous;
    case sine:
    case exponential:
    case quadratic:
    case inverse_root:
    case jump:
        return Group::one_dimensional;
    case two_peaks:
    case three_peaks:
    case four_peaks:
    case ridge:
        return Group::hard;
    default:
        return Group::smooth;
    }
}

BenchIntegrand::BenchIntegrand(Line line, std::uint64_t seed) : BenchProblem(seed), line_(line) {
    const bool flat = line_group(line) == Group::one_dimensional;
    const int least = line.family == discontinuous ? 2 : 1;
    if (line.dimensions < least || line.dimensions > (flat ? 1 : max_dimensions))
        throw Error("BenchIntegrand", "the family '" + std::string(facts_of(line.family).name) +
                                          "' has no integrand in " + std::to_string(line.dimensions) +
                                          " dimensions");
    Range range;
    if (line.family == sine) range.upper = std::numbers::pi / 2;
    if (line.family == exponential) range.upper = std::numeric_limits<double>::infinity();
    if (line.family == quadratic) range.lower = -1;
    set_ranges(std::vector<Range>(static_cast<std::size_t>(line.dimensions), range));
    draw_parameters(seed);
    set_exact(exact_integral(*this));
}

void BenchIntegrand::draw_parameters(std::uint64_t seed) {
    PhiloxStream numbers(hash_key(seed, static_cast<std::uint64_t>(line_.family), line_.dimensions));
    const int d = line_.dimensions;
    // In the open interval: a c of zero or a w on the edge belongs to another problem.
    auto uniform = [&] { return numbers.next_double() + 0x1p-54; };
    auto jitter = [&] { return 0.02 * uniform() - 0.01; };

    if (facts_of(line_.family).difficulty > 0) {
        for (int j = 0; j < d; ++j) w_[j] = uniform();
        double total = 0;
        for (int j = 0; j < d; ++j) {
            c_[j] = uniform();
            total += c_[j];
        }
        for (int j = 0; j < d; ++j) c_[j] *= facts_of(line_.family).difficulty / total;
        const double angle = (uniform() - 0.5) * std::numbers::pi / 2;
        if (line_.family == oscillatory) phase_ = angle - facts_of(line_.family).difficulty / 2;
    }
    if (line_.family == jump) w_[0] = 0.2 + 0.6 * uniform();

    auto place = [&](double narrowness, std::initializer_list<double> diagonal) {
        narrowness_ = narrowness;
        for (double p : diagonal) {
            for (int j = 0; j < d; ++j) centres_[peaks_][j] = p + jitter();
            ++peaks_;
        }
        scale_ = std::pow(narrowness / std::numbers::pi, 0.5 * d) / peaks_;
    };
    if (line_.family == two_peaks) place(100, {1.0 / 3, 2.0 / 3});
    if (line_.family == three_peaks) place(50, {0.23, 0.39, 0.74});
    if (line_.family == four_peaks) place(200, {0.2, 0.4, 0.6, 0.8});
    if (line_.family == ridge) {
        narrowness_ = 100;
        begin_ = 0.25 + jitter();
        end_ = 0.75 + jitter();
        // integral over t of exp(-K d (t - mean)^2) = sqrt(pi / (4 K d)) (erf - erf)
        scale_ = std::pow(narrowness_ / std::numbers::pi, 0.5 * d) / (end_ - begin_) *
                 std::sqrt(std::numbers::pi / (4 * narrowness_ * d));
    }
}

// |x - t (1, ..., 1)|^2 = d (t - mean)^2 + d (mean_square - mean^2), so that the integral over t is closed.
double BenchIntegrand::ridge_value(double mean, double mean_square) const {
    const double kd = narrowness_ * line_.dimensions;
    const double across = std::exp(-kd * std::max(0.0, mean_square - mean * mean));
    const double root = std::sqrt(kd);
    return scale_ * across * (std::erf(root * (end_ - mean)) - std::erf(root * (begin_ - mean)));
}

double BenchIntegrand::operator()(const double* x) const {
    const int d = line_.dimensions;
    auto identity = [](double v) { return v; };
    switch (line_.family) {
    case oscillatory:
        return sum_over_coordinates(
            x, d, [&](int j, double t) { return c_[j] * t; }, [&](double s) { return std::cos(phase_ + s); });
    case product_peak: {
        double product = 1;
        for (int j = 0; j < d; ++j) product *= 1 / (c_[j] * c_[j]) + (x[j] - w_[j]) * (x[j] - w_[j]);
        return 1 / product;
    }
    case corner_peak:
        return sum_over_coordinates(
            x, d, [&](int j, double t) { return c_[j] * t; }, [&](double s) { return corner(1 + s, d); });
    case gaussian:
        return sum_over_coordinates(
            x, d, [&](int j, double t) { return c_[j] * c_[j] * (t - w_[j]) * (t - w_[j]); },
            [](double s) { return std::exp(-s); });
    case continuous:
        return sum_over_coordinates(
            x, d, [&](int j, double t) { return c_[j] * std::abs(t - w_[j]); },
            [](double s) { return std::exp(-s); });
    case discontinuous:
        if (x[0] > w_[0] || x[1] > w_[1]) return 0;
        return sum_over_coordinates(
            x, d, [&](int j, double t) { return c_[j] * t; }, [](double s) { return std::exp(s); });
    case sine:
        return std::sin(x[0]);
    case exponential:
        return 5 * std::exp(-5 * x[0]);
    case quadratic:
        return 1.5 * x[0] * x[0];
    case inverse_root:
        return 0.5 / std::sqrt(x[0]);
    case jump:
        return x[0] <= w_[0] ? std::exp(x[0]) : 0;
    case two_peaks:
    case three_peaks:
    case four_peaks: {
        double total = 0;
        for (int k = 0; k < peaks_; ++k) {
            const double* p = centres_[k].data();
            total += sum_over_coordinates(
                x, d, [&](int j, double t) { return (t - p[j]) * (t - p[j]); },
                [&](double s) { return std::exp(-narrowness_ * s); });
        }
        return scale_ * total;
    }
    case ridge: {
        double mean = 0, mean_square = 0;
        for (int j = 0; j < d; ++j) {
            mean += x[j] / d;
            mean_square += x[j] * x[j] / d;
        }
        return ridge_value(mean, mean_square);
    }
    case sum:
        return sum_over_coordinates(
            x, d, [](int, double t) { return t; }, identity);
    }
    return 0;
}

void BenchIntegrand::evaluate(const double* const* x, std::size_t n, double* values) const {
    const int d = line_.dimensions;
    switch (line_.family) {
    case oscillatory:
        return sum_over_coordinates(
            x, d, n, values, [&](int j, double t) { return c_[j] * t; },
            [&](double s) { return std::cos(phase_ + s); });
    case product_peak:
        std::fill_n(values, n, 1.0);
        for (int j = 0; j < d; ++j)
            for (std::size_t i = 0; i < n; ++i) {
                const double t = x[j][i] - w_[j];
                values[i] *= 1 / (c_[j] * c_[j]) + t * t;
            }
        for (std::size_t i = 0; i < n; ++i) values[i] = 1 / values[i];
        return;
    case corner_peak:
        return sum_over_coordinates(
            x, d, n, values, [&](int j, double t) { return c_[j] * t; },
            [&](double s) { return corner(1 + s, d); });
    case gaussian:
        return sum_over_coordinates(
            x, d, n, values, [&](int j, double t) { return c_[j] * c_[j] * (t - w_[j]) * (t - w_[j]); },
            [](double s) { return std::exp(-s); });
    case continuous:
        return sum_over_coordinates(
            x, d, n, values, [&](int j, double t) { return c_[j] * std::abs(t - w_[j]); },
            [](double s) { return std::exp(-s); });
    case sum:
        return sum_over_coordinates(
            x, d, n, values, [](int, double t) { return t; }, [](double s) { return s; });
    default: {
        double point[max_dimensions];
        for (std::size_t i = 0; i < n; ++i) {
            for (int j = 0; j < d; ++j) point[j] = x[j][i];
            values[i] = (*this)(point);
        }
    }
    }
}

} // namespace montelux::bench
