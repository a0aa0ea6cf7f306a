// SplatFilm: sums of contributions that light paths bring to any pixel, from any thread, with the same bits in any order.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/film/pixel_filter.h"
#include "montelux/mc/math/vec.h"
#include "montelux/scene/film/film_settings.h"

namespace montelux {

// Sums of linear sRGB in fixed point: integer addition is associative, so neither the order of threads nor that of
// processes changes a bit. Each sum is a coarse integer in units of 2^-12 plus a fine one in units of 2^-48, which
// holds what the coarse one rounds off. A contribution is exact to 2^-49.
//
// No sum overflows with fewer than 2^17 contributions of the greatest magnitude and 2^28 contributions in all to one
// pixel between two calls of clear(). An overflow is counted, and the sum is then meaningless.
class SplatFilm {
  public:
    // A contribution of a larger magnitude is left out, as one that is not finite.
    static constexpr double most = 0x1p34;

    SplatFilm() = default;
    explicit SplatFilm(const PixelBounds& bounds);

    const PixelBounds& bounds() const { return bounds_; }

    // Adds to a pixel's sum; pixels outside of the bounds ignore it. Returns false, and counts the contribution as bad,
    // if it is NaN, infinite or too large in any component: then nothing is added. From any thread.
    bool add(int x, int y, Vec3d rgb);

    // Adds to all pixels whose filter reaches the film point, in pixels: `rgb` times the filter over its integral.
    // From any thread.
    void add_filtered(const PixelFilterSampler& filter, Point2f film, Vec3d rgb);

    // The members below must not run at the same time as add().

    Vec3d sum(int x, int y) const;
    // Contributions left out; overflows of sums.
    std::uint64_t bad() const { return bad_; }
    std::uint64_t overflows() const { return overflows_; }
    // All sums and counts become 0.
    void clear();
    // Adds the sums and counts of a film of the same bounds.
    void merge(const SplatFilm& other);

    // The state: six integers per pixel (coarse and fine of R, G, B), row by row, and the two counts. For
    // checkpoints and messages between processes.
    std::span<const std::int64_t> sums() const { return sums_; }
    std::span<std::int64_t> sums() { return sums_; }
    // Of pixels of a row, from (x, y) on.
    std::span<const std::int64_t> sums(int x, int y, int width) const {
        return sums().subspan(index(x, y), 6 * static_cast<std::size_t>(width));
    }
    // Adds such sums of another film.
    void merge_row(int x, int y, std::span<const std::int64_t> sums);
    bool is_zero(const PixelBounds& part) const;
    void set_counts(std::uint64_t bad, std::uint64_t overflows) {
        bad_ = bad;
        overflows_ = overflows;
    }

  private:
    std::size_t index(int x, int y) const {
        return 6 * (static_cast<std::size_t>(y - bounds_.y0) * static_cast<std::size_t>(bounds_.width()) +
                    static_cast<std::size_t>(x - bounds_.x0));
    }

    PixelBounds bounds_{};
    std::vector<std::int64_t> sums_;
    std::uint64_t bad_ = 0, overflows_ = 0;
};

} // namespace montelux
