// Error of the split sum against the full integral.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "montelux/bake/cube_frame.h"
#include "montelux/bake/environment_map.h"
#include "montelux/image/image.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

struct SplitSumSettings {
    std::vector<double> roughness{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
    std::vector<double> n_dot_v{0.1, 0.3, 0.5, 0.7, 0.9, 1.0};
    std::vector<double> f0{0.04, 1.0}; // reflectance along the normal
    int orientations = 64;             // of surface and view, for each row of the table
    int sphere_size = 96;              // pixels; 0: no picture
    double sphere_f0 = 1;
    // Standard error of either side relative to its mean of channels, or to the map's where that is darker.
    double target_error = 0.01;
    std::uint64_t samples_max = 1 << 16; // of the full integral at one place
    std::uint64_t seed = 0;
    CubeFrame frame;
    const CancelFlag* cancel = nullptr;
    std::function<void(double fraction)> progress;
};

// Over random orientations, in the mean of channels: `full` is the mean of the integral, `bias` the mean of
// split sum minus integral over `full` with the standard error of the orientations drawn, `rms` the root mean
// square of the difference over `full`, without the part due to the errors of both sides.
struct SplitSumRow {
    double roughness = 0, n_dot_v = 0, f0 = 0;
    double full = 0, bias = 0, bias_error = 0, rms = 0;
};

struct SplitSumReport {
    std::vector<SplitSumRow> rows;
    // Columns of spheres by roughness, seen from -z with the map around them: from the top the full integral,
    // the split sum, and the difference's size. Channels R, G, B and stderr.R, G, B.
    Image spheres;
    bool cancelled = false;
};

// Both sides use the same BRDF: GGX with height-correlated Smith masking and Schlick's Fresnel term. The full
// integral is estimated by multiple importance sampling of visible normals and of the map; the split sum is
// the prefiltered radiance at the mirror direction, for the exact roughness, not interpolated from a chain,
// times F0 * scale + bias.
SplitSumReport split_sum_report(const EnvironmentMap& map, const SplitSumSettings& settings);

} // namespace montelux
