#include "montelux/mc/integrate/vegas/hypercubes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr double even_part = 0.25; // Lepage's choice: three quarters of the points follow the spread
constexpr std::uint64_t few_boxes = 64;

} // namespace

void Hypercubes::resize(std::uint64_t most) {
    const std::size_t d = strata_.size();
    // The largest s with s^d <= most, then as many coordinates with s + 1 as fit.
    auto fits = [&](int s) {
        double product = 1;
        for (std::size_t j = 0; j < d && product <= static_cast<double>(most); ++j) product *= s;
        return product <= static_cast<double>(most);
    };
    int s = 1;
    while (fits(s + 1)) ++s;
    std::vector<int> strata(d, s);
    double product = std::pow(s, static_cast<double>(d));
    for (std::size_t j = 0; j < d; ++j) {
        product *= (s + 1.0) / s;
        if (product > static_cast<double>(most) * (1 + 1e-12)) break;
        strata[j] = s + 1;
    }
    if (strata == strata_) return;

    std::uint64_t count = 1;
    for (int n : strata) count *= static_cast<std::uint64_t>(n);
    std::vector<double> variances(count);
    std::vector<int> digit(d, 0);
    for (std::uint64_t h = 0; h < count; ++h) {
        std::size_t old = 0, step = 1;
        for (std::size_t j = 0; j < d && step < variances_.size(); ++j) {
            old += step *
                   static_cast<std::size_t>((2 * std::int64_t{digit[j]} + 1) * strata_[j] / (2 * strata[j]));
            step *= static_cast<std::size_t>(strata_[j]);
        }
        variances[h] = variances_[old];
        for (std::size_t j = 0; j < d && ++digit[j] == strata[j]; ++j) digit[j] = 0;
    }
    strata_ = std::move(strata);
    variances_ = std::move(variances);
}

std::vector<std::uint32_t> Hypercubes::allocate(std::uint64_t n, double beta) const {
    const double boxes = static_cast<double>(count()), points = static_cast<double>(n);
    const double least = std::max(2.0, std::floor(even_part * points / boxes));
    const double most = count() < few_boxes ? points : std::max(least, std::floor(points / 16));
    double total = 0;
    std::vector<double> wishes(variances_.size());
    const double largest = *std::max_element(variances_.begin(), variances_.end());
    for (std::size_t h = 0; h < wishes.size(); ++h)
        total += wishes[h] = largest > 0 ? std::pow(variances_[h] / largest, 0.5 * beta) : 1;
    // Minus a rounding error, which must not add a point.
    const double rest = std::max(0.0, points - least * boxes) / total * (1 - 1e-12);
    std::vector<std::uint32_t> counts(wishes.size());
    // Carries the fractions, so that all points are used.
    double carried = 0;
    for (std::size_t h = 0; h < counts.size(); ++h) {
        const double wanted = rest * wishes[h] + carried, given = std::floor(wanted);
        carried = wanted - given;
        counts[h] = static_cast<std::uint32_t>(std::min(least + given, most));
    }
    return counts;
}

void Hypercubes::learn(std::span<const double> variances) {
    for (std::size_t h = 0; h < variances_.size(); ++h)
        variances_[h] = known_ ? 0.5 * (variances_[h] + variances[h]) : variances[h];
    known_ = true;
}

void Hypercubes::place(PointBuffer& u, std::span<const double> box) const {
    if (count() == 1) return;
    constexpr std::size_t lanes = 256;
    std::array<double, lanes> rest;
    for (std::size_t begin = 0; begin < u.count(); begin += lanes) {
        const std::size_t n = std::min(lanes, u.count() - begin);
        std::copy_n(box.data() + begin, n, rest.data());
        for (int d = 0; d < u.dimensions(); ++d) {
            if (strata(d) == 1) continue;
            const double s = strata(d), inverse = 1 / s;
            double* at = u.coordinate(d).data() + begin;
            for (std::size_t i = 0; i < n; ++i) {
                // Exact: numbers of boxes are far below 2^52, and half a box away from the next quotient.
                const double quotient = std::floor((rest[i] + 0.5) * inverse);
                const double digit = rest[i] - s * quotient;
                at[i] = std::min((digit + at[i]) * inverse, 1 - 0x1p-53);
                rest[i] = quotient;
            }
        }
    }
}

void Hypercubes::save(StateWriter& state) const {
    state.put_all(strata_);
    state.put(variances_);
    state.put(known_);
}

void Hypercubes::load(StateReader& state) {
    std::vector<int> strata = state.get_all<int>();
    std::vector<double> variances = state.get_doubles();
    double product = 1;
    for (int s : strata) product *= s;
    if (strata.size() != strata_.size() || product != static_cast<double>(variances.size()))
        throw Error("the saved hypercubes have no possible shape");
    strata_ = std::move(strata);
    variances_ = std::move(variances);
    known_ = state.get<std::uint64_t>() != 0;
}

} // namespace montelux
