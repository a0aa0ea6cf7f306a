// Means of an environment map over the texels of a cube map: the sharpest level of a chain.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "montelux/bake/cube_frame.h"
#include "montelux/bake/environment_map.h"
#include "montelux/bake/texel_estimate.h"
#include "montelux/image/cube_map.h"

namespace montelux {

// A texel is cut into parts, finer and finer where the map changes across them, and the map is looked up at
// two points of each, weighted by their solid angles, less the radiance at the texel's centre, which is added
// again: unbiased, and exact where the map is constant. Cuts depend on the map's range in a part and not on
// samples, so there is no bias from them.
//
// If an edge of the map crosses a part with both points on one side, these agree and show no error. So a part
// crossed by an edge, judged by its corners, middle and points, gets the mean variance over positions of the
// edge: a sixth of the squared range for one point.
class AreaEstimator {
  public:
    AreaEstimator(const EnvironmentMap& map, const CubeFrame& frame) : map_(map), frame_(frame) {}

    // A pure function of the arguments.
    TexelEstimate estimate(const CubeTexel& texel, int size, const TexelTarget& target, std::uint64_t key);

  private:
    // A position in the texel, in [0, 1]^2, and its position on the map.
    struct Place {
        Vec2f grid;
        Vec3f radiance;
    };
    // A square of the texel, in units of 1 / resolution of its edge.
    struct Part {
        std::uint32_t x = 0, y = 0, resolution = 1;
        std::array<Place, 4> corners; // (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)
        Place middle;
        Vec3f low, high;          // of the map's radiance within the part
        float weighted_range = 0; // the largest of the channels, times the share of the texel
        bool is_known = true;     // whether the range is that of all texels of the map in the part
    };
    Place place(double u, double v) const;
    void finish(Part& part) const;
    void cut_evenly(std::uint32_t n);
    // Cuts parts with a larger range than `allowed`, while there are at most `most` of them; whether all are
    // done.
    bool refine(float allowed, std::size_t most);
    TexelEstimate sample(std::uint64_t key, std::uint32_t round) const;

    const EnvironmentMap& map_;
    CubeFrame frame_;
    CubeTexel texel_;
    int size_ = 1;
    std::vector<Part> parts_, next_;
};

} // namespace montelux
