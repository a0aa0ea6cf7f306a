// Integrals of an environment map under a radial kernel, by sampling within adaptive cells.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/bake/environment_map.h"
#include "montelux/bake/radial_kernel.h"
#include "montelux/bake/texel_estimate.h"

namespace montelux {

// Kernel and map are known in closed form, their product is not. The map's quadtree is cut into cells over
// which the kernel varies little, as far as each contributes to the error: small cells at a sun, large ones
// in the sky. A cell contributes its exact energy times the kernel at its middle, plus the mean deviation of
// the kernel at two or four directions drawn in proportion to the map's sum of channels: unbiased, and no
// value of the map is met by chance. The spread of the directions gives each cell's variance, and their sum
// the texel's; cells that may have most of it get four directions. A cut that misses the target is refined,
// and only the last round counts.
class CellEstimator {
  public:
    CellEstimator(const EnvironmentMap& map, const RadialKernel& kernel) : map_(map), kernel_(kernel) {}

    // `direction`: unit vector in the map's frame; a pure function of the arguments.
    TexelEstimate estimate(Vec3f direction, const TexelTarget& target, std::uint64_t key);

  private:
    static constexpr std::uint32_t fewest_samples = 2, most_samples = 4; // of a cell

    struct Cell {
        MapCell cell;
        float sum = 0;    // of its energy's channels
        float kernel = 0; // at the middle
        std::uint32_t samples = fewest_samples;
    };
    // Fills cells_: those whose energy times the kernel's range in them is at most `allowed`, or the best
    // that `most` samples can do. Without `allowed`, cells that are small beside their distance and the
    // kernel's width. Returns whether `most` was the limit.
    bool cut(Vec3f direction, float allowed, std::size_t most);
    void split(const Cell& cell);
    Vec3f energy_of(const MapCell& cell) const;
    TexelEstimate sample_cells(Vec3f direction, std::uint64_t key, std::uint32_t round) const;

    const EnvironmentMap& map_;
    RadialKernel kernel_;
    std::vector<Cell> cells_, open_, next_;
};

} // namespace montelux
