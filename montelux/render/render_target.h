// RenderTarget: the target error, time limit, allocation and slice of a render.
#pragma once

#include "montelux/render/sample_order.h"

namespace montelux {

// The samples per pixel of the description's sampler are a limit: for the mean over the picture with adaptive
// allocation, for each pixel without.
struct RenderTarget {
    // Relative error of the picture (FilmError::relative), or the error, relative to the mean luminance,
    // within which a share `quantile` of the pixels lies. 0: none.
    double error = 0;
    double quantile = 0;
    double time = 0; // seconds of wall clock, of all sessions of a resumed render; 0: no limit
    bool adaptive = false;
    Slice slice{};

    bool operator==(const RenderTarget&) const = default;
};

} // namespace montelux
