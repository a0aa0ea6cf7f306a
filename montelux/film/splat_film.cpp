#include "montelux/film/splat_film.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

void SplatFilm::add_filtered(const PixelFilterSampler& filter, Point2f film, Vec3d rgb) {
    const Vec2f r = filter.radius();
    const auto range = [](float at, float radius, int low, int high) {
        const float from = std::ceil(at - 0.5f - radius), to = std::floor(at - 0.5f + radius);
        return std::pair(static_cast<int>(std::max(from, static_cast<float>(low))),
                         static_cast<int>(std::min(to, static_cast<float>(high - 1))));
    };
    const auto [x0, x1] = range(film.x, r.x, bounds_.x0, bounds_.x1);
    const auto [y0, y1] = range(film.y, r.y, bounds_.y0, bounds_.y1);
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const Vec2f offset{film.x - (static_cast<float>(x) + 0.5f),
                               film.y - (static_cast<float>(y) + 0.5f)};
            if (const float weight = filter.normalized(offset); weight != 0) add(x, y, rgb * double(weight));
        }
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
    for (int y = bounds_.y0; y < bounds_.y1; ++y)
        merge_row(bounds_.x0, y, other.sums(bounds_.x0, y, bounds_.width()));
}

void SplatFilm::merge_row(int x, int y, std::span<const std::int64_t> sums) {
    std::int64_t* into = &sums_[index(x, y)];
    for (const std::int64_t value : sums) {
        if (__builtin_add_overflow(*into, value, into)) ++overflows_;
        ++into;
    }
}

bool SplatFilm::is_zero(const PixelBounds& part) const {
    for (int y = part.y0; y < part.y1; ++y)
        for (const std::int64_t value : sums(part.x0, y, part.width()))
            if (value != 0) return false;
    return true;
}

} // namespace montelux
