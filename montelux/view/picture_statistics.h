// PictureStatistics: the error of a live picture, how it is distributed, and in how many pixels it shows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "montelux/image/tone_curve.h"
#include "montelux/view/live_picture.h"

namespace montelux {

// Of the pixels' relative errors: equal bins of their decimal logarithm. Values beyond count in the outer bins.
struct ErrorHistogram {
    static constexpr double least = -4, most = 1;
    static constexpr std::size_t bins = 50;

    std::vector<std::uint64_t> counts = std::vector<std::uint64_t>(bins);
    std::uint64_t infinite = 0; // pixels whose error is not known yet
};

struct PictureStatistics {
    std::optional<double> error{}; // FilmError::relative; empty while it is not finite
    double samples = 0;            // mean per pixel
    ErrorHistogram histogram{};
    double visible = 1; // visible_error_share under the curve, of at most 65536 pixels
};

PictureStatistics statistics_of(std::span<const LivePixel> pixels, const ToneCurve& curve);

} // namespace montelux
