// The table of the split sum's second factor: scale and bias of GGX over n.v and roughness.
#pragma once

#include <functional>

#include "montelux/image/image.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

// Content of channel B.
enum class BrdfTableExtra {
    zero,
    sheen,         // BrdfIntegrals::charlie_sheen
    average_albedo // BrdfIntegrals::ggx_average_albedo; the same along a row
};

struct BrdfTableSettings {
    int size = 256;
    BrdfTableExtra extra = BrdfTableExtra::zero;
    const CancelFlag* cancel = nullptr;
    std::function<void(double fraction)> progress; // called from time to time by the calling thread
};

// Channels R (scale), G (bias) and B (extra), and "error.R", "error.G", "error.B": distance to the quadrature
// with half as many nodes, an upper bound far above the error. Texel (x, y) belongs to n.v = (x + 1/2) / size
// and perceptual roughness (y + 1/2) / size with alpha = roughness^2, so the first row is the smoothest.
// 32-bit float. Throws Error when the size is not in [1, 4096]; an empty image when it was cancelled.
Image brdf_table(const BrdfTableSettings& settings);

} // namespace montelux
