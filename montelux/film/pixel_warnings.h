// Pixels whose error bars are unreliable: rare bright light reached them once, or only their neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace montelux {

class Film;

// Values of the layer `warning`.
enum class PixelWarning : std::uint8_t {
    none = 0,
    bright_replicate = 1, // one replicate contributes most of the variance
    neighbours = 2, // the neighbours' variance is far larger: light may have been missed, or an edge is near
    unknown = 3,    // fewer than 16 replicates: too few to decide
};
// Whether the error bar is known to be unreliable.
inline bool marks_unreliable_error(PixelWarning d) {
    return d == PixelWarning::bright_replicate || d == PixelWarning::neighbours;
}

// The quantities that decide. Variance NaN: too few replicates.
struct PixelSpread {
    double variance = 0; // of a sample's luminance
    bool bright_replicate = false;
};
// Row by row, as `pixels`. A pixel is compared with the mean variance of its up to eight neighbours.
std::vector<PixelWarning> pixel_warnings(std::span<const PixelSpread> pixels, int width);

PixelSpread pixel_spread(double luminance_error, double samples, double replicates, double largest_share);
std::vector<PixelWarning> pixel_warnings(const Film& film);

} // namespace montelux
