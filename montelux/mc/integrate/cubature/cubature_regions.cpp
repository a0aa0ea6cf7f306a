#include "montelux/mc/integrate/cubature/cubature_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "montelux/mc/math/error.h"

namespace montelux {

double CubatureRegions::volume(std::size_t r) const {
    double volume = 1;
    for (double h : half_width(r)) volume *= 2 * h;
    return volume;
}

double CubatureRegions::distance(std::size_t r, std::span<const double> x) const {
    double distance = 0;
    for (std::size_t d = 0; d < n_; ++d)
        distance = std::max(distance, std::abs(x[d] - centre(r)[d]) / half_width(r)[d]);
    return distance;
}

bool CubatureRegions::touches(std::size_t r, std::span<const double> x) const {
    for (std::size_t d = 0; d < n_; ++d)
        if (std::abs(x[d] - centre(r)[d]) > half_width(r)[d]) return false;
    return true;
}

std::size_t CubatureRegions::containing(std::span<const double> x) const {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < count() && least > 1; ++r) {
        const double here = distance(r, x);
        if (here < least) {
            least = here;
            nearest = r;
        }
    }
    return nearest;
}

void CubatureRegions::resize(std::size_t count) {
    centre_.resize(count * n_);
    half_width_.resize(count * n_);
    value_.resize(count * m_);
    error_.resize(count * m_);
    face_error_.resize(count * m_);
    lowest_.resize(count * m_);
    highest_.resize(count * m_);
    series_.resize(count * m_);
    if (n_ == 1) faces_.resize(2 * count * m_);
    marks_.resize(count);
}

void CubatureRegions::add_cube() {
    resize(count() + 1);
    std::ranges::fill(centre(count() - 1), 0.5);
    std::ranges::fill(half_width(count() - 1), 0.5);
}

void CubatureRegions::add_halves(const CubatureRegions& from, std::size_t region) {
    const std::size_t first = count(), axis = from.marks(region).axis;
    resize(first + 2);
    for (std::size_t side = 0; side < 2; ++side) {
        std::ranges::copy(from.centre(region), centre(first + side).begin());
        std::ranges::copy(from.half_width(region), half_width(first + side).begin());
        double& h = half_width(first + side)[axis];
        h /= 2;
        centre(first + side)[axis] += side == 0 ? -h : h;
    }
}

void CubatureRegions::copy(std::size_t to, const CubatureRegions& from, std::size_t r) {
    std::ranges::copy(from.centre(r), centre(to).begin());
    std::ranges::copy(from.half_width(r), half_width(to).begin());
    std::ranges::copy(from.value(r), value(to).begin());
    std::ranges::copy(from.error(r), error(to).begin());
    std::ranges::copy(from.face_error(r), face_error(to).begin());
    std::ranges::copy(from.lowest(r), lowest(to).begin());
    std::ranges::copy(from.highest(r), highest(to).begin());
    for (std::size_t i = 0; n_ == 1 && i < 2 * m_; ++i) faces_[2 * to * m_ + i] = from.faces_[2 * r * m_ + i];
    for (std::size_t c = 0; c < m_; ++c) series_[to * m_ + c] = from.series_[r * m_ + c];
    marks(to) = from.marks(r);
}

void CubatureRegions::save(StateWriter& state) const {
    for (const auto* numbers : {&centre_, &half_width_, &value_, &error_, &face_error_, &lowest_, &highest_})
        state.put(*numbers);
    for (const Series& q : series_)
        for (double x : {q.difference, q.log_ratio, q.ratios}) state.put(x);
    for (const Face& f : faces_)
        for (double x : {f.value, f.slack, f.unseen}) state.put(x);
    for (const Marks& m : marks_)
        state.put(static_cast<std::uint64_t>(m.axis | m.face_axis << 8 | m.rough << 16 | m.exhausted << 17 |
                                             m.indivisible << 18 | m.face_upper << 19));
}

void CubatureRegions::load(StateReader& state) {
    for (auto* numbers : {&centre_, &half_width_, &value_, &error_, &face_error_, &lowest_, &highest_})
        *numbers = state.get_doubles();
    const std::size_t regions = centre_.size() / n_;
    if (centre_.size() != regions * n_ || half_width_.size() != regions * n_ ||
        std::ranges::any_of(std::array{&value_, &error_, &face_error_, &lowest_, &highest_},
                            [&](const auto* numbers) { return numbers->size() != regions * m_; }))
        throw Error("the saved regions do not fit the dimensions or components");
    series_.resize(regions * m_);
    for (Series& q : series_)
        for (double* x : {&q.difference, &q.log_ratio, &q.ratios}) *x = state.get_double();
    faces_.resize(n_ == 1 ? 2 * regions * m_ : 0);
    for (Face& f : faces_)
        for (double* x : {&f.value, &f.slack, &f.unseen}) *x = state.get_double();
    marks_.resize(regions);
    for (Marks& m : marks_) {
        const std::uint64_t word = state.get_word();
        m.axis = static_cast<std::uint8_t>(word);
        m.face_axis = static_cast<std::uint8_t>(word >> 8);
        m.rough = (word >> 16 & 1) != 0;
        m.exhausted = (word >> 17 & 1) != 0;
        m.indivisible = (word >> 18 & 1) != 0;
        m.face_upper = (word >> 19 & 1) != 0;
        if (m.axis >= n_) throw Error("a saved region is to be halved along an axis that there is not");
    }
}

} // namespace montelux
