// Integrals of an environment map under the GGX lobe, by sampling directions from the lobe only.
#pragma once

#include <cstdint>

#include "montelux/bake/environment_map.h"
#include "montelux/bake/radial_kernel.h"
#include "montelux/bake/texel_estimate.h"
#include "montelux/mc/dist/family/ggx_angle.h"

namespace montelux {

// The plain estimator, as in most bakers: half vectors from D(h) n.h, which for n = v are the visible normals
// as well, weighted by n.l; scrambled Sobol' points in independent randomisations, whose spread gives the
// error. Unbiased, but few directions hit a small sun.
class LobeEstimator {
  public:
    // `source_mips`: look radiance up in averages over as many texels as a sample stands for (Krivanek and
    // Colbert 2008, "Real-time Shading with Filtered Importance Sampling"). Less noise, and a bias that the
    // errors do not include.
    LobeEstimator(const EnvironmentMap& map, double alpha, bool source_mips);

    TexelEstimate estimate(Vec3f direction, const TexelTarget& target, std::uint64_t key) const;

  private:
    static constexpr int replicates = 32, least_points = 16;

    Vec3d sum_of_points(const Vec3f (&axes)[3], std::uint64_t key, std::uint32_t begin, std::uint32_t end,
                        double solid_angle_scale) const;

    const EnvironmentMap& map_;
    double alpha_;
    GgxAngleDistribution half_vectors_;
    bool source_mips_;
    double mean_cosine_; // of n.l over the directions that are drawn, those below the horizon counting 0
};

} // namespace montelux
