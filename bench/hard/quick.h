// The comparison of continuous integration: a small part of the bank, judged by counts.
#pragma once

#include <string_view>

namespace montelux::bench {

// The runs are fixed, so that only a change of the library changes the counts: a limit is lowered whenever
// the count is.
struct QuickLimit {
    std::string_view method;
    int silent; // most silent failures allowed
};

// What is run: seeds 0, ..., quick_seeds - 1 of every family at each target.
inline constexpr int quick_seeds = 4;
inline constexpr double quick_targets[] = {1e-2, 1e-3};
inline constexpr double quick_cap = 500000;
inline constexpr double quick_seconds = 20;
inline constexpr QuickLimit quick_limits[] = {{"auto", 0}, {"adaptive", 0}};
// Shares of the runs that converged whose truth lies within one and two claimed errors, by Student's law of
// 15 degrees of freedom: adaptive has 16 replicates. The errors of `auto` may be larger, because those of
// cubature are bounds. A share that is this many standard deviations of a binomial count below fails.
inline constexpr double quick_within_one = 0.667, quick_within_two = 0.936;
inline constexpr double quick_deviations = 3.9;

} // namespace montelux::bench
