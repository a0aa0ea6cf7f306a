// FilmError: the error of a whole picture, and its distribution over the pixels.
#pragma once

#include <cstdint>
#include <span>

#include "montelux/film/pixel_warnings.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

class Film;
class Pixel;

// The error of the whole picture, as shown while rendering and written to the file.
struct FilmError {
    // Root mean square over pixels of the standard error of luminance, over the mean luminance.
    double relative = 0;
    double mean_luminance = 0;
    double mean_samples = 0; // per pixel
};
FilmError error_of(const Film& film);

// Luminance of linear sRGB (IEC 61966-2-1).
inline constexpr Vec3d luminance_weight{0.2126, 0.7152, 0.0722};
// Standard error of a pixel's luminance, bounded by the triangle inequality; channels are strongly
// correlated, so the bound is tight. Infinite below two replicates.
double luminance_error(const Pixel& pixel);

// Degrees of freedom of the picture's error, by Satterthwaite's formula. Small where few pixels with few
// replicates carry the error. Infinite at zero variance, 0 where a pixel has fewer than two replicates.
double error_freedom(const Film& film);

// The error, relative to the picture's mean luminance, that a share `quantile` of the pixels does not exceed.
double error_quantile(const Film& film, double quantile);
struct ErrorQuantile {
    double share = 0; // of the pixels
    double error = 0;
};

// Mean over pixels of the luminance that clamping removed.
double clamped_luminance(const Film& film);

// Fireflies: the pixels that carry the error of a picture.
struct OutlierReport {
    // Pixels with the greatest errors that carry half of the squared error, and their share of all.
    std::uint64_t pixels_of_half = 0;
    double share_of_half = 0;
    std::uint64_t heavy_tailed = 0; // pixels (PixelWarning::bright_replicate)
    double heavy_error_share = 0;   // their share of the squared error
    std::uint64_t outshone = 0;     // pixels (PixelWarning::neighbours)
    std::uint64_t unknown = 0;      // pixels (PixelWarning::unknown)
    std::uint64_t pixels = 0;       // all
};
OutlierReport outliers_of(const Film& film);
// From the standard errors of the pixels' luminances.
OutlierReport outliers_of(std::span<const double> errors, std::span<const PixelWarning> warnings);

} // namespace montelux
