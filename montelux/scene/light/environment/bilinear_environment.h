// BilinearEnvironment: samples a bilinearly interpolated environment map in proportion to its light.
#pragma once

#include <vector>

#include "montelux/mc/dist/piecewise_bilinear_2d.h"
#include "montelux/scene/light/environment/environment_density.h"

namespace montelux {

// MISSION C6 with a density that follows the interpolation exactly: it is bilinear between the centres of
// texels, and per solid angle as well, since equal areas of a texel are equal solid angles.
class BilinearEnvironment {
  public:
    // `light` holds the light of individual texels; `grid` must outlive it.
    BilinearEnvironment(const EnvironmentGrid& grid, const std::vector<float>& light)
        : grid_(&grid), table_(table_of(grid, light)) {}

    EnvironmentPoint sample(Vec2f u) const {
        const auto s = table_.sample(u);
        const Vec2f p{keep_below(s.p.x, static_cast<float>(grid_->width())),
                      keep_below(s.p.y, static_cast<float>(grid_->height()))};
        // Where rows of texels differ, a cell lies within one.
        return {p, per_solid_angle(s.pdf, s.row)};
    }
    float pdf(Vec2f grid) const { return per_solid_angle(table_.pdf(grid), table_.row_of(grid.y)); }
    std::size_t bytes() const { return table_.bytes(); }

  private:
    static PiecewiseBilinear2D table_of(const EnvironmentGrid& grid, const std::vector<float>& light);
    float per_solid_angle(float pdf, std::uint32_t row) const {
        const bool halves = grid_->layout() == EnvironmentLayout::equirectangular;
        return static_cast<float>(static_cast<double>(pdf) /
                                  grid_->solid_angle(halves ? static_cast<int>(row / 2) : 0));
    }

    const EnvironmentGrid* grid_;
    PiecewiseBilinear2D table_;
};

} // namespace montelux
