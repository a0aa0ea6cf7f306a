// Batches of points of independent randomisations of a point set.
#pragma once

#include <cstdint>
#include <optional>

#include "montelux/mc/integrate/points.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/random/point_set.h"

namespace montelux {

// One replicate of a set. Points lie inside the cube, never on its faces, where maps to infinite ranges are
// not finite.
class RandomisedPoints {
  public:
    // `count`: as PointSet has it, for Hammersley; other sets have 2^32 - 1 points, and scrambled Sobol'
    // 2^32. Throws Error.
    RandomisedPoints(PointSetKind kind, Randomisation randomisation, int dimensions, std::uint32_t count,
                     std::uint64_t seed, std::uint32_t replicate);

    // Fills u with points first, first + 1, ...
    void fill(PointBuffer& u, std::uint64_t first) const;

  private:
    std::optional<ScrambledSobol> sobol_;
    std::optional<PointSet> set_;
};

} // namespace montelux
