// The comparison that continuous integration makes: a small part of the bank, judged by counts.
#pragma once

#include <string_view>

namespace montelux::bench {

struct QuickLimit {
    std::string_view method;
    int silent; // at most so many silent failures
};

// What is run: seeds 0, ..., quick_seeds - 1 of every family at one target.
inline constexpr int quick_seeds = 4;
inline constexpr double quick_target = 1e-3;
inline constexpr double quick_cap = 300000;
inline constexpr double quick_seconds = 20;
inline constexpr QuickLimit quick_limits[] = {{"auto", 1000}, {"adaptive", 1000}};

} // namespace montelux::bench
