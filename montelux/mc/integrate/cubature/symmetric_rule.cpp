#include "montelux/mc/integrate/cubature/symmetric_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using Exponents = std::vector<int>; // even, not increasing, none zero

// The even degrees of at most `dimensions` variables that add up to `total`: symmetric polynomials that are
// even in every variable; all others give zero by symmetry.
void for_each_partition(int total, int dimensions, const std::function<void(const Exponents&)>& visit) {
    Exponents parts;
    auto recurse = [&](auto& self, int rest, int largest) -> void {
        if (rest == 0) {
            visit(parts);
            return;
        }
        if (static_cast<int>(parts.size()) == dimensions) return;
        for (int part = std::min(rest, largest); part >= 2; part -= 2) {
            parts.push_back(part);
            self(self, rest - part, part);
            parts.pop_back();
        }
    };
    recurse(recurse, total, total);
}

// Divisor of values before they are squared and summed: 1, except for values whose squares leave the range of
// numbers, as in the far tail of a peak.
double unit_of_squares(std::span<const double> values) {
    double largest = 0;
    for (double v : values) largest = std::max(largest, std::abs(v));
    return largest > 0 && (largest < 1e-140 || largest > 1e140) && std::isfinite(largest) ? largest : 1;
}

// Legendre polynomials of mean square 1 over [-1, 1], up to degree n.
std::vector<long double> legendre(int n, long double x) {
    std::vector<long double> p{1, x};
    for (int k = 1; k < n; ++k)
        p.push_back(
            ((2 * k + 1) * x * p[static_cast<std::size_t>(k)] - k * p[static_cast<std::size_t>(k - 1)]) /
            (k + 1));
    for (int k = 0; k <= n; ++k) p[static_cast<std::size_t>(k)] *= std::sqrt(2.0L * k + 1);
    return p;
}

// Mean over an orbit of the product of Legendre polynomials with these degrees in distinct variables. A
// point of the orbit has the generator's coordinates in some places and zeros elsewhere, so the mean is over
// the ways to give each of the polynomials a coordinate of its own.
long double orbit_mean(const Exponents& degrees, const SymmetricRule::Generator& generator, int dimensions) {
    // Coordinates that are equal are interchangeable: values with how often they occur.
    std::vector<double> values{0};
    std::vector<int> left{dimensions - static_cast<int>(generator.size())};
    for (double g : generator) {
        auto at = std::find(values.begin(), values.end(), g);
        if (at == values.end()) {
            values.push_back(g);
            left.push_back(1);
        } else {
            ++left[static_cast<std::size_t>(at - values.begin())];
        }
    }
    std::vector<std::vector<long double>> p;
    p.reserve(values.size());
    const int highest = degrees.empty() ? 1 : degrees.front();
    for (double v : values) p.push_back(legendre(highest, v));
    int remaining = dimensions;
    auto recurse = [&](auto& self, std::size_t k) -> long double {
        if (k == degrees.size()) return 1;
        long double sum = 0;
        for (std::size_t v = 0; v < values.size(); ++v) {
            if (left[v] == 0) continue;
            const long double chance = static_cast<long double>(left[v]) / remaining;
            --left[v];
            --remaining;
            sum += chance * p[v][static_cast<std::size_t>(degrees[k])] * self(self, k + 1);
            ++left[v];
            ++remaining;
        }
        return sum;
    };
    return recurse(recurse, 0);
}

} // namespace

SymmetricRule::SymmetricRule(int dimensions, int degree, std::vector<Generator> generators, double probe)
    : dimensions_(dimensions), degree_(degree), probe_at_(probe) {
    for (Generator& g : generators) std::sort(g.begin(), g.end());
    std::vector<PointBuffer> parts;
    std::size_t count = 0;
    for (const Generator& g : generators) {
        parts.push_back(orbit(dimensions, g));
        orbits_.push_back({count, parts.back().count()});
        count += parts.back().count();
    }
    if (probe > 0) {
        first_probe_ = count;
        parts.push_back(orbit(dimensions, {probe}));
        count += parts.back().count();
    }
    points_.resize(count, dimensions);
    for (int d = 0; d < dimensions; ++d) {
        auto to = points_.coordinate(d).begin();
        for (PointBuffer& part : parts) to = std::ranges::copy(part.coordinate(d), to).out;
    }
    std::vector<std::size_t> axes;
    for (std::size_t o = 0; o < generators.size(); ++o)
        if (generators[o].size() == 1) axes.push_back(o);
    std::ranges::sort(axes, {}, [&](std::size_t o) { return generators[o][0]; });
    if (axes.size() >= 2) {
        inner_ = axes[0];
        outer_ = probe > 0 ? axes.back() : axes[1];
        inner_at_ = generators[inner_][0];
        outer_at_ = generators[outer_][0];
        const std::size_t last = axes.back(), before = axes[axes.size() - 2];
        first_last_ = probe > 0 ? first_probe_ : orbits_[last].first;
        last_at_ = probe > 0 ? probe : generators[last][0];
        first_before_ = orbits_[probe > 0 ? last : before].first;
        before_at_ = generators[probe > 0 ? last : before][0];
    }
    solve(generators);
    if (dimensions == 1) solve_odd(generators);
}

// All arrangements and signs. Points on an axis come as +e_1, -e_1, +e_2, ...
PointBuffer SymmetricRule::orbit(int dimensions, const Generator& generator) {
    std::vector<double> places(static_cast<std::size_t>(dimensions), 0.0);
    std::ranges::copy(generator, places.end() - static_cast<std::ptrdiff_t>(generator.size()));
    std::vector<std::vector<double>> found;
    do { // from the sorted arrangement to the reversed one, each once
        for (std::size_t signs = std::size_t{1} << generator.size(); signs-- > 0;) {
            found.push_back(places);
            std::size_t bit = 0;
            for (double& x : found.back())
                if (x != 0 && ((signs >> bit++) & 1) == 0) x = -x;
        }
    } while (std::ranges::next_permutation(places).found);
    if (generator.size() == 1) { // the nonzero place went from the last to the first
        std::ranges::reverse(found);
        for (std::size_t i = 0; i + 1 < found.size(); i += 2) std::swap(found[i], found[i + 1]);
    }
    PointBuffer points(found.size(), dimensions);
    for (std::size_t i = 0; i < found.size(); ++i)
        for (int d = 0; d < dimensions; ++d) points(i, d) = found[i][static_cast<std::size_t>(d)];
    return points;
}

// Unknown are z_j = w_j sqrt(c_j) for an orbit of c_j points with weight w_j, whose Euclidean norm is that of
// the weights at the points. The equations of degree 0, 2, 4 ... made orthonormal one after another give an
// orthonormal basis of rules: the part that equations of degree d add is null up to degree d - 1.
void SymmetricRule::solve(const std::vector<Generator>& generators) {
    const std::size_t m = generators.size();
    std::vector<long double> root(m);
    for (std::size_t j = 0; j < m; ++j) root[j] = std::sqrt(static_cast<long double>(orbits_[j].count));
    std::vector<std::vector<long double>> basis;
    std::vector<long double> targets;
    std::vector<int> degrees;
    long double largest_miss = 0;
    // Equations are few and of similar size; the remainder of a dependent one is rounding.
    constexpr long double dependent = 1e-9L;
    auto add_equation = [&](std::vector<long double> row, long double target, int degree, bool exact) {
        long double norm_before = 0, norm = 0;
        for (long double x : row) norm_before += x * x;
        for (int pass = 0; pass < 2; ++pass)
            for (std::size_t b = 0; b < basis.size(); ++b) {
                long double dot = 0;
                for (std::size_t j = 0; j < m; ++j) dot += row[j] * basis[b][j];
                for (std::size_t j = 0; j < m; ++j) row[j] -= dot * basis[b][j];
                if (exact) target -= dot * targets[b];
            }
        for (long double x : row) norm += x * x;
        if (norm <= dependent * dependent * norm_before) {
            if (exact) largest_miss = std::max(largest_miss, std::abs(target));
            return;
        }
        norm = std::sqrt(norm);
        for (long double& x : row) x /= norm;
        basis.push_back(std::move(row));
        targets.push_back(exact ? target / norm : 0);
        degrees.push_back(degree);
    };
    for (int d = 0; d <= degree_; d += 2)
        for_each_partition(d, dimensions_, [&](const Exponents& exponents) {
            std::vector<long double> row(m);
            for (std::size_t j = 0; j < m; ++j)
                row[j] = orbit_mean(exponents, generators[j], dimensions_) * root[j];
            add_equation(std::move(row), d == 0 ? 1 : 0, d - 1, true);
        });
    if (largest_miss > 1e-10L)
        throw Error("SymmetricRule", "these generators allow no rule of degree " + std::to_string(degree_));
    // The free part of the solution.
    for (std::size_t j = 0; j < m; ++j) {
        std::vector<long double> row(m, 0.0L);
        row[j] = 1;
        add_equation(std::move(row), 0, degree_, false);
    }
    long double norm = 0;
    weights_.assign(m, 0.0);
    for (std::size_t j = 0; j < m; ++j) {
        long double z = 0;
        for (std::size_t b = 0; b < basis.size(); ++b) z += targets[b] * basis[b][j];
        norm += z * z;
        weights_[j] = static_cast<double>(z / root[j]);
    }
    norm = std::sqrt(norm);
    for (std::size_t b = basis.size(); b-- > 1;) {
        null_degrees_.push_back(degrees[b]);
        for (std::size_t j = 0; j < m; ++j)
            null_weights_.push_back(static_cast<double>(norm * basis[b][j] / root[j]));
    }
}

// Equations of degree 1, 3, 5 ... made orthonormal one after another give the null rules of the odd part, as those of the
// even part above.
void SymmetricRule::solve_odd(const std::vector<Generator>& generators) {
    const std::size_t pairs = generators.size() - 1; // the first is the centre
    const int highest = 2 * static_cast<int>(pairs) - 1;
    std::vector<std::vector<long double>> basis;
    for (int d = 1; d <= highest; d += 2) {
        std::vector<long double> row;
        for (std::size_t j = 0; j < pairs; ++j)
            row.push_back(legendre(highest, generators[j + 1][0])[static_cast<std::size_t>(d)]);
        for (int pass = 0; pass < 2; ++pass)
            for (const auto& other : basis) {
                const long double along = std::inner_product(row.begin(), row.end(), other.begin(), 0.0L);
                for (std::size_t j = 0; j < pairs; ++j) row[j] -= along * other[j];
            }
        const long double norm = std::sqrt(std::inner_product(row.begin(), row.end(), row.begin(), 0.0L));
        for (long double& x : row) x /= norm;
        basis.push_back(std::move(row));
    }
    long double squares = weights_[0] * weights_[0];
    for (std::size_t j = 0; j < pairs; ++j) squares += 2 * weights_[j + 1] * weights_[j + 1];
    for (std::size_t b = basis.size(); b-- > 1;)
        for (long double x : basis[b])
            odd_null_weights_.push_back(static_cast<double>(std::sqrt(squares / 2) * x));
}

double SymmetricRule::apply(std::span<const double> values, std::span<double> nulls) const {
    double mean = 0;
    std::fill(nulls.begin(), nulls.end(), 0.0);
    const std::size_t m = orbits_.size();
    for (std::size_t j = 0; j < m; ++j) {
        double sum = 0;
        for (double v : values.subspan(orbits_[j].first, orbits_[j].count)) sum += v;
        mean += weights_[j] * sum;
        for (std::size_t k = 0; k < nulls.size(); ++k) nulls[k] += null_weights_[k * m + j] * sum;
    }
    return mean;
}

SymmetricRule::Assessment SymmetricRule::assess(std::span<const double> nulls, double rounding) const {
    const double unit = unit_of_squares(nulls);
    // Root square sums of the null rules of each degree; the three highest degrees decide.
    std::array<double, 3> size{};
    std::size_t groups = 0;
    int degree = -1;
    for (std::size_t k = 0; k < nulls.size(); ++k) {
        if (null_degrees_[k] != degree) {
            if (groups == size.size()) break;
            degree = null_degrees_[k];
            ++groups;
        }
        size[groups - 1] += (nulls[k] / unit) * (nulls[k] / unit);
    }
    for (double& s : size) s = unit * std::sqrt(s);
    return assess_sizes(std::span(size).first(groups), rounding);
}

SymmetricRule::Assessment SymmetricRule::assess_sizes(std::span<const double> sizes, double rounding) {
    Assessment result{0, 0};
    for (std::size_t g = 0; g + 1 < sizes.size(); ++g)
        if (sizes[g] > rounding)
            result.ratio = std::max(result.ratio, sizes[g + 1] > 0 ? sizes[g] / sizes[g + 1]
                                                                   : std::numeric_limits<double>::infinity());
    for (double size : sizes) result.error = std::max(result.error, size);
    constexpr double caution = 4;
    if (result.ratio < 1) result.error = std::min(result.error, caution * result.ratio * sizes[0]);
    return result;
}

double SymmetricRule::odd_surprise(std::span<const double> values, double rounding) const {
    if (odd_null_weights_.empty()) return 0;
    const std::size_t pairs = orbits_.size() - 1;
    std::array<double, 3> sizes{};
    std::size_t count = 0;
    for (; count < std::min(sizes.size(), odd_null_weights_.size() / pairs); ++count) {
        double sum = 0;
        for (std::size_t j = 0; j < pairs; ++j) {
            const double* f = &values[orbits_[j + 1].first];
            sum += odd_null_weights_[count * pairs + j] * (f[0] - f[1]);
        }
        sizes[count] = std::abs(sum);
    }
    const Assessment found = assess_sizes(std::span(sizes).first(count), rounding);
    if (found.ratio >= 1) return found.error;
    // The null rules' degrees are below 2 pairs; the factor once more for each two up to the rule's own.
    return found.error * std::pow(found.ratio, (degree_ - 2 * static_cast<int>(pairs) - 1) / 2);
}

SymmetricRule::AxisTerms SymmetricRule::axis_terms(std::span<const double> values, std::size_t d) const {
    const double a = inner_at_ * inner_at_, b = outer_at_ * outer_at_, p = probe_at_ * probe_at_;
    const double centre = values[0];
    const double *inner = &values[orbits_[inner_].first], *outer = &values[orbits_[outer_].first];
    // The quartic's even part is centre + x^2 (...), its odd part x (...), both linear in x^2 within.
    auto even_part = [&](const double* f) { return (f[2 * d] + f[2 * d + 1]) / 2 - centre; };
    auto odd_part = [&](const double* f) { return (f[2 * d] - f[2 * d + 1]) / 2; };
    const double near = even_part(inner), far = even_part(outer);
    AxisTerms terms{(near / a - far / b) / (a - b), 0, 0};
    if (probe_at_ == 0) return terms;
    const double* probe = &values[first_probe_];
    terms.even = even_part(probe) - near * p * (p - b) / (a * (a - b)) - far * p * (p - a) / (b * (b - a));
    terms.odd = odd_part(probe) - probe_at_ * (odd_part(inner) / inner_at_ * (p - b) / (a - b) +
                                               odd_part(outer) / outer_at_ * (p - a) / (b - a));
    return terms;
}

void SymmetricRule::add_roughness(std::span<const double> values, double scale,
                                  std::span<double> sums) const {
    for (std::size_t d = 0; d < sums.size(); ++d) {
        const AxisTerms terms = axis_terms(values, d);
        sums[d] += scale * (0.1 * std::abs(terms.quartic) + std::abs(terms.even) + std::abs(terms.odd));
    }
}

double SymmetricRule::edge_surprise(std::span<const double> values) const {
    if (probe_at_ == 0) return 0;
    const double unit = unit_of_squares(values);
    double squares = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimensions_); ++d) {
        const AxisTerms terms = axis_terms(values, d);
        // As much as the next terms of a smooth function may add: of the order of the quartic's own.
        const double expected = 0.8 * std::abs(terms.quartic);
        for (const double surprise : {terms.even + terms.odd, terms.even - terms.odd}) {
            const double beyond = std::max(0.0, std::abs(surprise) - expected) / unit;
            squares += beyond * beyond;
        }
    }
    return unit * std::sqrt(squares) * (1 - outer_at_) / 2;
}

SymmetricRule::FaceValue SymmetricRule::face_value(std::span<const double> values, int axis,
                                                   bool upper) const {
    const std::size_t at = 2 * static_cast<std::size_t>(axis) + (upper ? 0 : 1);
    const double last = values[first_last_ + at], before = values[first_before_ + at];
    const double step = (last - before) * (1 - last_at_) / (last_at_ - before_at_);
    return {last + step, std::abs(step), (1 - last_at_) / 2};
}

} // namespace montelux
