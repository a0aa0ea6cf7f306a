#include "montelux/film/pixel_warnings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "montelux/film/film.h"
#include "montelux/film/film_error.h"

namespace montelux {
namespace {

constexpr double enough_replicates = 16, heavy_share = 0.5;
// Measured (docs/render-to-an-error.md): with a factor of 4 the error bars of unmarked pixels are still
// slightly too small; with 2 every edge is marked.
constexpr double far_larger = 3;

double mean_variance_around(std::span<const PixelSpread> pixels, int width, int height, int x, int y) {
    double sum = 0;
    int count = 0;
    for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
            const double variance = pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                                           static_cast<std::size_t>(u)]
                                        .variance;
            if ((u == x && v == y) || !std::isfinite(variance)) continue;
            sum += variance;
            ++count;
        }
    return count > 0 ? sum / count : 0;
}

} // namespace

std::vector<PixelWarning> pixel_warnings(std::span<const PixelSpread> pixels, int width) {
    std::vector<PixelWarning> warnings(pixels.size(), PixelWarning::none);
    const int height = static_cast<int>(pixels.size()) / width;
    std::size_t i = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, ++i) {
            if (std::isnan(pixels[i].variance))
                warnings[i] = PixelWarning::unknown;
            else if (pixels[i].bright_replicate)
                warnings[i] = PixelWarning::bright_replicate;
            else if (mean_variance_around(pixels, width, height, x, y) > far_larger * pixels[i].variance)
                warnings[i] = PixelWarning::neighbours;
        }
    return warnings;
}

PixelSpread pixel_spread(double luminance_error, double samples, double replicates, double largest_share) {
    if (replicates < enough_replicates) return {std::numeric_limits<double>::quiet_NaN(), false};
    return {luminance_error * luminance_error * samples, largest_share > heavy_share};
}

std::vector<PixelWarning> pixel_warnings(const Film& film) {
    std::vector<PixelSpread> spreads;
    spreads.reserve(film.pixels().size());
    for (const Pixel& p : film.pixels())
        spreads.push_back(pixel_spread(luminance_error(p), p.samples(),
                                       static_cast<double>(p.replicates().count()), p.largest_share()));
    return pixel_warnings(spreads, film.bounds().width());
}

} // namespace montelux
