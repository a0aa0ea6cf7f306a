// TabulatedEnvironment: samples an environment map texel by texel, in proportion to their light.
#pragma once

#include <span>

#include "montelux/mc/dist/piecewise_2d.h"
#include "montelux/scene/light/environment/environment_density.h"

namespace montelux {

// MISSION C6: the row by the sum of its light, the texel within the row, a place uniform in the texel.
// u.y picks the row, u.x the column.
class TabulatedEnvironment {
  public:
    // `grid` must outlive it.
    TabulatedEnvironment(const EnvironmentGrid& grid, std::span<const float> light)
        : grid_(&grid),
          table_(light, static_cast<std::uint32_t>(grid.width()), static_cast<std::uint32_t>(grid.height()),
                 {0, 0}, {static_cast<double>(grid.width()), static_cast<double>(grid.height())}) {}

    EnvironmentPoint sample(Vec2f u) const {
        auto s = table_.sample(u);
        return {keep_in_texel(s.p, s.column, s.row),
                static_cast<float>(double(s.pdf) / grid_->solid_angle(static_cast<int>(s.row)))};
    }
    float pdf(Vec2f grid) const {
        return static_cast<float>(double(table_.pdf(grid)) / grid_->solid_angle(static_cast<int>(grid.y)));
    }
    std::size_t bytes() const { return table_.bytes(); }

  private:
    const EnvironmentGrid* grid_;
    PiecewiseConstant2D table_;
};

} // namespace montelux
