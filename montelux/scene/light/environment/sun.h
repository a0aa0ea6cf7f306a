// The sun of an environment map: a small bright part with a density of its own.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "montelux/mc/dist/discrete.h"
#include "montelux/mc/dist/piecewise_2d.h"
#include "montelux/scene/light/environment/environment_density.h"

namespace montelux {

// Texels connected with the brightest one that contain at least a tenth of the light, fill at most 0.01 sr
// (the sun's disc: 0.00007 sr), and are sampled in proportion to their light.
class Sun {
  public:
    // Removes the sun's light from `light`; empty if there is no sun. A sun across the edge of the map is
    // found on one side of it only. `grid` must outlive it.
    static std::optional<Sun> take_from(std::vector<float>& light, const EnvironmentGrid& grid);

    // The sun's share of the map's light.
    double share() const { return share_; }
    std::size_t texels() const { return texels_; }
    EnvironmentPoint sample(Vec2f u) const {
        auto s = table_.sample(u);
        auto column = s.column + static_cast<std::uint32_t>(table_.lower().x);
        auto row = s.row + static_cast<std::uint32_t>(table_.lower().y);
        return {keep_in_texel(s.p, column, row),
                static_cast<float>(double(s.pdf) / grid_->solid_angle(static_cast<int>(row)))};
    }
    float pdf(Vec2f grid) const {
        // Points on its far edges belong to the next texels.
        if (!(double(grid.x) < table_.upper().x && double(grid.y) < table_.upper().y)) return 0;
        return static_cast<float>(double(table_.pdf(grid)) / grid_->solid_angle(static_cast<int>(grid.y)));
    }

  private:
    Sun(const EnvironmentGrid& grid, double share, std::size_t texels, PiecewiseConstant2D table)
        : grid_(&grid), share_(share), texels_(texels), table_(std::move(table)) {}

    const EnvironmentGrid* grid_;
    double share_;
    std::size_t texels_;
    PiecewiseConstant2D table_; // of the rectangle around it, in grid points
};

// A density for everything but the sun, and the sun's: u.x picks one of them by its light.
template <typename Density>
class WithSun {
  public:
    WithSun(std::optional<Sun> sun, Density rest)
        : sun_(std::move(sun)), rest_(std::move(rest)),
          // The rest keeps a share if it is not black.
          share_(!sun_ ? 0.0f
                 : sun_->share() == 1
                     ? 1.0f
                     : std::min(static_cast<float>(sun_->share()), largest_below_one<float>)) {}

    EnvironmentPoint sample(Vec2f u) const {
        if (!(share_ > 0)) return rest_.sample(u);
        if (u.x < share_) {
            EnvironmentPoint p = sun_->sample({std::min(u.x / share_, largest_below_one<float>), u.y});
            // Regions of the rest may overlap the sun.
            p.pdf = share_ * p.pdf + (1 - share_) * rest_.pdf(p.grid);
            return p;
        }
        EnvironmentPoint p =
            rest_.sample({std::min((u.x - share_) / (1 - share_), largest_below_one<float>), u.y});
        p.pdf = (1 - share_) * p.pdf + share_ * sun_->pdf(p.grid);
        return p;
    }
    float pdf(Vec2f grid) const {
        if (!(share_ > 0)) return rest_.pdf(grid);
        return (1 - share_) * rest_.pdf(grid) + share_ * sun_->pdf(grid);
    }
    const Sun* sun() const { return sun_ ? &*sun_ : nullptr; }
    const Density& rest() const { return rest_; }

  private:
    std::optional<Sun> sun_;
    Density rest_;
    float share_;
};

} // namespace montelux
