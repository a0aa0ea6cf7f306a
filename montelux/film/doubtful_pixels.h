// Pixels whose error bars are rough: rare bright light that they have met once, or that only their neighbours
// met.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace montelux {

class Film;

// Values of the layer `doubt`.
enum class Doubt : std::uint8_t {
    none = 0,
    bright_unit = 1, // one unit alone makes up most of the variance
    neighbours = 2,  // the neighbours' variance is far larger: light may have been missed, or an edge is near
    unknown = 3,     // fewer than 16 units, too few to tell
};
// Was there evidence that the error is rough?
inline bool speaks_against(Doubt d) { return d == Doubt::bright_unit || d == Doubt::neighbours; }

// What is asked of a pixel. Errors of too few units are no evidence either way: variance NaN.
struct PixelSpread {
    double variance = 0; // of a sample's luminance
    bool bright_unit = false;
};
// Row by row, as `pixels`. A pixel is held against the mean variance of the up to eight around it.
std::vector<Doubt> doubtful_pixels(std::span<const PixelSpread> pixels, int width);

PixelSpread pixel_spread(double luminance_error, double samples, double units, double largest_share);
std::vector<Doubt> doubtful_pixels(const Film& film);

} // namespace montelux
