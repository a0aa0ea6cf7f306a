// Splat: what a light path brings to a point of the film.
#pragma once

#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// The pixel's value is the sum over splats of radiance times the pixel filter, divided by its integral and by the
// number of light paths for each square pixel of the film's crop.
struct Splat {
    Point2f film; // in pixels
    SampledSpectrum radiance;
};
using SplatList = std::vector<Splat>;

} // namespace montelux
