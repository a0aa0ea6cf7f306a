// MedianCutEnvironment: samples an environment map by regions of equal light, with equal probability.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "montelux/mc/dist/discrete.h"
#include "montelux/scene/light/environment/environment_density.h"

namespace montelux {

// The map is cut into 2^levels regions as in Debevec 2005, "A Median Cut Algorithm for Light Probe Sampling":
// each region is cut across its longer side (in angles) into two halves of equal light. Cuts may pass through
// texels, so halves are equal up to rounding. A sample picks a region and a uniform direction in it, as in
// Mei, Jaeger, Hu 2006, "An Effective Stratified Sampling Scheme for Environment Maps with Median Cut
// Method". Black borders of regions are trimmed; the density is zero there.
//
// u.x picks the region; neighbours in this order are connected at every level of the cut, so low-discrepancy
// points stratify over all of them.
class MedianCutEnvironment {
  public:
    static constexpr int default_levels = 12;

    // levels in [0, 16]; `grid` must outlive it. A black map is cut at the midpoints.
    MedianCutEnvironment(const EnvironmentGrid& grid, const std::vector<float>& light,
                         int levels = default_levels);

    struct Region {
        float x0, x1, y0, y1;  // of the grid
        double share0, share1; // EnvironmentGrid::share_above of y0 and y1
        float pdf;             // over solid angle
    };
    const std::vector<Region>& regions() const { return regions_; }

    EnvironmentPoint sample(Vec2f u) const {
        const float scaled = u.x * static_cast<float>(regions_.size());
        const auto index = std::min(static_cast<std::size_t>(scaled), regions_.size() - 1);
        const Region& r = regions_[index];
        const float within = std::min(scaled - static_cast<float>(index), largest_below_one<float>);
        const double share = r.share0 + static_cast<double>(u.y) * (r.share1 - r.share0);
        return {{std::clamp(r.x0 + within * (r.x1 - r.x0), r.x0, std::nextafter(r.x1, 0.0f)),
                 std::clamp(static_cast<float>(grid_->line_below(share)), r.y0, std::nextafter(r.y1, 0.0f))},
                r.pdf};
    }
    float pdf(Vec2f grid) const {
        const Region& r = regions_[region_of(grid)];
        const bool inside = grid.x >= r.x0 && grid.x < r.x1 && grid.y >= r.y0 && grid.y < r.y1;
        return inside ? r.pdf : 0;
    }
    std::size_t region_of(Vec2f grid) const {
        std::size_t cut = 1;
        while (cut < regions_.size()) {
            const Cut& c = cuts_[cut];
            cut = 2 * cut + ((c.across_x ? grid.x : grid.y) >= c.at ? 1 : 0);
        }
        return cut - regions_.size();
    }
    std::size_t bytes() const { return cuts_.size() * sizeof(Cut) + regions_.size() * sizeof(Region); }

  private:
    struct Cut {
        float at;
        bool across_x;
    };
    friend class MedianCutter;

    const EnvironmentGrid* grid_;
    std::vector<Cut> cuts_; // a heap: the children of cut i are 2 i and 2 i + 1, the root is 1
    std::vector<Region> regions_;
};

} // namespace montelux
