// Prefiltered environment maps for real-time engines: cube maps blurred by the GGX lobe level by level, and
// by the cosine.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "montelux/bake/cube_frame.h"
#include "montelux/bake/environment_map.h"
#include "montelux/image/cube_map.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

enum class PrefilterSampling {
    cells, // cell_estimate.h
    lobe   // lobe_estimate.h
};

struct BakeSettings {
    PrefilterSampling sampling = PrefilterSampling::cells;
    bool source_mips = false; // with `lobe` alone
    // Target standard error of each channel of a texel relative to the mean of its channels; without it
    // `samples` are taken.
    std::optional<double> target_error = 0.01;
    // Texels darker than this share of the map's mean are measured by the share.
    double dark_floor = 0.01;
    // With a target: the most that one round of a texel may take.
    std::uint64_t samples = 1 << 20;
    std::uint64_t seed = 0;
    CubeFrame frame;
    const CancelFlag* cancel = nullptr;
    std::function<void(double fraction)> progress; // called from time to time by the calling thread
};

struct LevelReport {
    int size = 0;
    double roughness = 0;
    std::uint64_t samples = 0; // of all texels
    std::uint64_t missed = 0;  // texels whose error is above the target
    // Of the texels' largest channel errors relative to the scale of the target; 0 without light.
    double mean_error = 0, largest_error = 0;
};

struct BakedCubes {
    CubeMapChain value, standard_error;
    std::vector<LevelReport> levels;
    bool cancelled = false; // then the rest is incomplete
};

// Perceptual roughness of each level, alpha = roughness^2, as engines look their levels up.
// linear:   level / (levels - 1), which most engines take.
// filament: 1 - sqrt(1 - level / (levels - 1)), the inverse of its level = (levels - 1) r (2 - r).
// babylon:  alpha = 2^(level / 0.8) / size, at most 1, the inverse of its level = 0.8 log2(size alpha); 0 at
//           level 0.
enum class RoughnessRule { linear, filament, babylon };
// Of `levels` levels, the first with faces of `size` texels; without it from `size` down to 16 texels, or the
// one where there is no more; with babylon's rule down to 1. Throws Error on more levels than such faces
// have.
std::vector<double> roughness_by_rule(RoughnessRule rule, std::optional<int> levels, int size);

// One level for each roughness in [0, 1]; the first has faces of size x size texels. A roughness of 0 gives
// the mean of the map over each texel, any other the radiance that the GGX lobe with n = v = r reflects, over
// that of a white map. The same bits for any number of threads. Throws Error on an invalid size, roughness or
// number of levels.
BakedCubes prefilter_environment(const EnvironmentMap& map, int size, const std::vector<double>& roughness,
                                 const BakeSettings& settings);

// Irradiance over pi: the radiance of a white Lambertian surface that faces the texel's direction. One level.
BakedCubes irradiance_cube(const EnvironmentMap& map, int size, const BakeSettings& settings);

} // namespace montelux
