// RenderTarget: the error, time limit, allocation and slice that a render is asked for.
#pragma once

#include "montelux/render/sample_order.h"

namespace montelux {

// What is asked for. The samples of the description's sampler are the most a pixel gets: on average over the
// picture where they are allocated adaptively, each where they are not.
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
