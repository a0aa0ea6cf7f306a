// Arithmetic whose roundings are random, to see which digits of a formula they decide.
#pragma once

#include <cstdint>

namespace montelux::app {

// Rounds up or down at random on this thread for a scope (Monte Carlo arithmetic; Parker 1997, "Monte Carlo Arithmetic:
// exploiting the non-deterministic nature of round-off"). Two scopes with the same seed, one of them `opposite`, differ in
// each rounding.
class RandomRounding {
  public:
    RandomRounding(std::uint64_t seed, bool opposite);
    ~RandomRounding();
    RandomRounding(const RandomRounding&) = delete;
    RandomRounding& operator=(const RandomRounding&) = delete;

    // Chooses the direction of the operations that follow.
    static void turn();
    // One of the two neighbours of a value, but for zero and infinity.
    static double moved(double value);
    // A random number in (0, 1).
    static double fraction();
};

// Rounds to the nearest number for a scope.
class NearestRounding {
  public:
    NearestRounding();
    ~NearestRounding();
    NearestRounding(const NearestRounding&) = delete;
    NearestRounding& operator=(const NearestRounding&) = delete;

  private:
    int before_;
};

} // namespace montelux::app
