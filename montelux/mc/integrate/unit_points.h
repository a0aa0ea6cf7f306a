// Batches of points of the unit cube: pseudo-random, and scrambled Sobol'.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/points.h"
#include "montelux/mc/random/sobol.h"

namespace montelux {

// Fills u with pseudo-random points first, first + 1, ... of a stream: each coordinate a pure function of
// (seed, stream, index, dimension), uniform on (0, 1) in steps of 2^-52, never at its ends.
void fill_random(PointBuffer& u, std::uint64_t seed, std::uint32_t stream, std::uint64_t first);

// The Sobol' sequence under Owen scrambles that are independent for each (seed, replicate). Digits beyond the
// 32nd continue the scramble, so that points are uniform on (0, 1) in steps of 2^-52 over seeds.
class ScrambledSobol {
  public:
    static constexpr std::uint64_t max_points = std::uint64_t{1} << 32;

    // Throws Error for more dimensions than the sequence has (1024).
    ScrambledSobol(int dimensions, std::uint64_t seed, std::uint32_t replicate);

    // Fills u, which has this many dimensions, with points first, first + 1, ...
    void fill(PointBuffer& u, std::uint64_t first) const;

    // Tables to compute the points elsewhere: a key of each dimension, and 32 bit-reversed generator columns.
    std::span<const std::uint32_t> keys() const { return keys_; }
    std::span<const std::uint32_t> columns() const { return columns_; }

  private:
    std::vector<std::uint32_t> keys_;
    std::vector<std::uint32_t> columns_;
};

} // namespace montelux
