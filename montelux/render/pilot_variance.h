// PilotPicture: what a pilot of an integrator saw of some tiles, and the variance of its samples.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace montelux {

// A part of the light of each pixel: two independent estimates of its luminance, pixel by pixel.
struct PilotPart {
    std::vector<float> first, second;
    // Samples per pixel that each estimate stands for.
    double samples = 1;
};

// The estimate of a picture: the sum of its parts, whose errors are independent.
struct PilotPicture {
    std::vector<PilotPart> parts;
    // Whether its means are evidence of light that other integrators miss: the two estimates suffice for errors of means
    // over tiles.
    bool is_evidence = true;
};

// Of which error the variance is.
enum class PilotMeasure : unsigned char {
    pixels,  // relative to each pixel: that of the eye, and of relMSE
    picture, // relative to the mean of the picture: FilmError::relative
};

// Relative variance of one sample per pixel, for each picture, over the same tiles; 0 for all if none shows any light.
// `tile_ends`: number of pixels up to the end of each tile.
//
// Differences of the two estimates give each pixel's variance without bias. Two samples rarely meet light that a method
// finds with small probability, and then report a small variance. So means over tiles are compared, too: where another
// picture shows more light than this one by more than three of their errors, the samples of this one missed the
// difference, and the mean of n samples that misses light L has an expected squared error of L^2, a variance of n L^2
// of one sample. More light, not less: what is missed lowers a mean, and fireflies that raise it raise its error as well.
//
// Variances are divided by the squares of the same means for all: those of the picture with the smallest variance
// relative to its mean, in each tile, and of no less than half its mean over all tiles. Means of others would
// follow their own fireflies.
std::vector<double> relative_variances(std::span<const PilotPicture> pictures,
                                       std::span<const std::size_t> tile_ends, PilotMeasure measure);

} // namespace montelux
