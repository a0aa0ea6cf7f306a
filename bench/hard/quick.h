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
inline constexpr QuickLimit quick_limits[] = {{"auto", 3}, {"adaptive", 5}};

} // namespace montelux::bench
