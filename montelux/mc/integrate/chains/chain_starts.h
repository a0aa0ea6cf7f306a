// Where Markov chains and the walkers of ensembles start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/chains/log_density_calls.h"
#include "montelux/mc/integrate/domain.h"

namespace montelux {

// `walkers` different points, one after the other, among random points of the domain (4 for each walker, at least 1000),
// drawn in proportion to their density. Throws Error where fewer have a density above zero.
std::vector<double> random_starts(LogDensityCalls& density, const Domain& domain, std::size_t walkers,
                                  std::uint64_t seed, std::uint32_t chain);

// The start itself and `walkers` - 1 points about it that have a density above zero: normal, with a deviation of 1 % of
// a finite range, else of the coordinate (at least of 1), reflected at the ends of ranges, and less where that is outside
// of the support. Throws Error where the density is zero at the start or everywhere about it.
std::vector<double> scattered_starts(LogDensityCalls& density, const std::vector<double>& start,
                                     const Domain& domain, std::size_t walkers, std::uint64_t seed,
                                     std::uint32_t chain);

// Do walkers of dimension d, one after the other, reach the whole space by moves along their differences? Throws Error
// where these span a subspace only, up to rounding. `within_halves`: differences of walkers of one half alone, as slices
// have them, else of all.
void expect_spanning_starts(std::span<const double> starts, std::size_t dimensions, bool within_halves,
                            std::uint32_t ensemble);

} // namespace montelux
