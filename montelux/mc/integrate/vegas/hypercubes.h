// Adaptive stratification: a grid of hypercubes, with points in proportion to the spread of values in each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/points.h"
#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// The unit cube, cut into s_1 x ... x s_d equal boxes ("hypercubes"), which are numbered with the first
// coordinate running fastest. Box h gets n_h points: a fixed part is shared evenly, and the rest in
// proportion to sigma_h^beta, where sigma_h is the spread of values found there before. Lepage 2021,
// "Adaptive multidimensional integration: VEGAS enhanced", section III.
class Hypercubes {
  public:
    // One box.
    explicit Hypercubes(int dimensions)
        : strata_(static_cast<std::size_t>(dimensions), 1), variances_(1, 0) {}

    std::uint64_t count() const { return variances_.size(); }
    // s_d.
    int strata(int d) const { return strata_[static_cast<std::size_t>(d)]; }
    std::span<const int> strata() const { return strata_; }

    // The finest grid of at most `most` boxes whose s_d differ by one at most, larger ones first. A new box
    // inherits the spread of the old one around its centre.
    void resize(std::uint64_t most);

    // n_h for at most n points in all: at least two per box (n >= 2 count()), and with 64 boxes and more at
    // most a sixteenth in one (which would keep a single thread busy, perhaps on an outlier).
    std::vector<std::uint32_t> allocate(std::uint64_t n, double beta) const;

    // Blends in the variances found in each box; the old ones keep a half, since two or three points say
    // little.
    void learn(std::span<const double> variances);

    // Moves points u, uniform in the unit cube, into boxes: box[i] is the number of point i's.
    void place(PointBuffer& u, std::span<const double> box) const;

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    std::vector<int> strata_;
    std::vector<double> variances_; // of a value in each box; all 0 while nothing is known
    bool known_ = false;
};

} // namespace montelux
