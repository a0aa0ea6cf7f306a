#include "montelux/film/splat_film.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

constexpr double coarse_unit = 0x1p-12, fine_unit = 0x1p-48;

bool is_good(double v) { return std::abs(v) <= SplatFilm::most; } // false for NaN

// Returns whether the sum overflowed.
bool add_atomically(std::int64_t& sum, std::int64_t value) {
    if (value == 0) return false;
    const std::int64_t before = std::atomic_ref(sum).fetch_add(value, std::memory_order_relaxed);
    std::int64_t after;
    return __builtin_add_overflow(before, value, &after);
}

} // namespace

SplatFilm::SplatFilm(const PixelBounds& bounds) : bounds_(bounds) {
    if (bounds.width() < 1 || bounds.height() < 1) throw Error("film", "the splats' bounds hold no pixel");
    sums_.resize(6 * static_cast<std::size_t>(bounds.width()) * static_cast<std::size_t>(bounds.height()));
}

bool SplatFilm::add(int x, int y, Vec3d rgb) {
    if (x < bounds_.x0 || x >= bounds_.x1 || y < bounds_.y0 || y >= bounds_.y1) return true;
    if (!is_good(rgb.x) || !is_good(rgb.y) || !is_good(rgb.z)) {
        std::atomic_ref(bad_).fetch_add(1, std::memory_order_relaxed);
        return false;
    }
    std::int64_t* const sums = &sums_[index(x, y)];
    for (int c = 0; c < 3; ++c) {
        const double coarse = std::nearbyint(rgb[c] / coarse_unit);
        const double rest = rgb[c] - coarse * coarse_unit; // exact
        const auto fine = static_cast<std::int64_t>(std::nearbyint(rest / fine_unit));
        bool overflowed = add_atomically(sums[2 * c], static_cast<std::int64_t>(coarse));
        overflowed |= add_atomically(sums[2 * c + 1], fine);
        if (overflowed) std::atomic_ref(overflows_).fetch_add(1, std::memory_order_relaxed);
    }
    return true;
}

Vec3d SplatFilm::sum(int x, int y) const {
    const std::int64_t* const sums = &sums_[index(x, y)];
    Vec3d rgb;
    for (int c = 0; c < 3; ++c)
        rgb[c] =
            static_cast<double>(sums[2 * c]) * coarse_unit + static_cast<double>(sums[2 * c + 1]) * fine_unit;
    return rgb;
}

void SplatFilm::clear() {
    std::ranges::fill(sums_, std::int64_t{0});
    bad_ = overflows_ = 0;
}

void SplatFilm::merge(const SplatFilm& other) {
    if (other.sums_.size() != sums_.size())
        throw Error("film", "splats of films of different bounds cannot be added");
    bad_ += other.bad_;
    overflows_ += other.overflows_;
    for (std::size_t i = 0; i < sums_.size(); ++i)
        if (__builtin_add_overflow(sums_[i], other.sums_[i], &sums_[i])) ++overflows_;
}

} // namespace montelux
