// Where Markov chains and the walkers of ensembles start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "montelux/mc/integrate/chains/log_density_calls.h"
#include "montelux/mc/integrate/domain.h"

namespace montelux {

// `walkers` different points, one after the other, among 1000 random points of the domain, drawn in proportion to their
// density. Throws Error where fewer have a density above zero.
std::vector<double> random_starts(LogDensityCalls& density, const Domain& domain, std::size_t walkers,
                                  std::uint64_t seed, std::uint32_t chain);

// The start itself and `walkers` - 1 points about it that have a density above zero: normal, with a deviation of 1 % of
// a finite range, else of the coordinate (at least of 1), and less where that is outside of the support. Throws Error
// where the density is zero at the start or everywhere about it.
std::vector<double> scattered_starts(LogDensityCalls& density, const std::vector<double>& start,
                                     const Domain& domain, std::size_t walkers, std::uint64_t seed,
                                     std::uint32_t chain);

} // namespace montelux
