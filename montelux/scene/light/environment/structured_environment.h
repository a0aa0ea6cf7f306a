// StructuredEnvironment: samples an environment map by strata of brightness and size, uniform in each.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "montelux/mc/dist/discrete.h"
#include "montelux/mc/dist/search.h"
#include "montelux/scene/light/environment/environment_density.h"

namespace montelux {

// Agarwal, Ramamoorthi, Belongie, Jensen 2003, "Structured Importance Sampling of Environment Maps":
// 1. The map is thresholded at i * sigma, i = 0 ... 5, sigma the standard deviation of its radiance. Each
//    connected part above a threshold, without the parts above the next one, gets strata in proportion to
//    its importance Gamma = L * min(solid angle, 0.01 sr)^(1/4), L its light. Above 0 there is one part.
// 2. Within a part the centres of the strata are placed by the farthest-point rule of Hochbaum and Shmoys
//    1985, "A Best Possible Heuristic for the k-Center Problem", starting with the centres of brighter parts
//    within it; each cell belongs to the nearest centre.
// 3. Used with jitter: u.x picks a stratum, all with equal probability, and the direction is uniform in it.
// A part with an importance of less than half a stratum is merged with the part around it, and every part has
// a stratum, so their number may differ from the requested one. Maps of more than 2^17 texels are processed
// in square blocks of texels. The density is zero where the map is black.
class StructuredEnvironment {
  public:
    static constexpr int default_strata = 1024;
    static constexpr int thresholds = 6;

    // `grid` must outlive it.
    StructuredEnvironment(const EnvironmentGrid& grid, const std::vector<float>& light,
                          int strata = default_strata);

    std::size_t strata() const { return pdf_.size(); }
    // The threshold of the part of a stratum, and the centre of the cell that it grew from.
    int level_of(std::size_t stratum) const { return level_[stratum]; }
    Vec2f centre_of(std::size_t stratum) const;
    static constexpr std::uint32_t no_stratum = 0xffffffff;
    std::uint32_t stratum_of(Vec2f grid) const {
        const auto x = static_cast<std::size_t>(grid.x), y = static_cast<std::size_t>(grid.y);
        return stratum_of_[y / block_ * columns_ + x / block_];
    }

    EnvironmentPoint sample(Vec2f u) const {
        const float scaled = u.x * static_cast<float>(strata());
        const auto s = std::min(static_cast<std::size_t>(scaled), strata() - 1);
        const float within = std::min(scaled - static_cast<float>(s), largest_below_one<float>);
        const std::size_t first = first_[s], n = first_[s + 1] - first;
        const std::size_t i = find_last_not_above(before_.data() + first, n, static_cast<double>(u.y));
        const double from = before_[first + i], to = i + 1 < n ? before_[first + i + 1] : 1;
        return {place(cells_[first + i], within, (static_cast<double>(u.y) - from) / (to - from)), pdf_[s]};
    }
    float pdf(Vec2f grid) const {
        const std::uint32_t s = stratum_of(grid);
        return s == no_stratum ? 0 : pdf_[s];
    }
    std::size_t bytes() const {
        return (stratum_of_.size() + first_.size() + cells_.size() + centre_.size()) * sizeof(std::uint32_t) +
               level_.size() + // one byte each
               before_.size() * sizeof(double) + pdf_.size() * sizeof(float);
    }

  private:
    friend class StratumBuilder;
    // Uniform in a cell over u and v in [0, 1).
    Vec2f place(std::uint32_t cell, float u, double v) const;

    const EnvironmentGrid* grid_;
    std::size_t block_, columns_, rows_;    // texels along a side of a cell; cells
    std::vector<std::uint32_t> stratum_of_; // of each cell
    std::vector<std::uint32_t> first_;      // of each stratum's cells, in cells_, and the end
    std::vector<std::uint32_t> cells_;
    std::vector<double> before_; // share of its stratum that lies in cells before it
    // Of each stratum:
    std::vector<float> pdf_; // over solid angle
    std::vector<std::uint32_t> centre_;
    std::vector<std::uint8_t> level_;
};

} // namespace montelux
