// Low-discrepancy point sets by name: random access by (index, dimension), plain or randomised.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace montelux {

enum class PointSetKind : std::uint8_t { independent, halton, hammersley, sobol, golden_ratio, weyl };

enum class Randomisation : std::uint8_t {
    none,
    shift,             // adds one random vector modulo 1 (Cranley, Patterson 1976); every kind
    digit_permutation, // one random digit permutation per base, then a shift; Halton and Hammersley
    scramble,          // nested (Owen 1995); Halton, Hammersley and Sobol'
};

// The names of the enumerators ("golden_ratio"), for command lines.
std::string_view to_string(PointSetKind kind);
std::string_view to_string(Randomisation randomisation);
std::optional<PointSetKind> point_set_kind(std::string_view name);
std::optional<Randomisation> randomisation(std::string_view name);

// At most `count` points in [0, 1)^dimensions. van der Corput is the first dimension of Halton. Over seeds,
// every randomised point is uniform, so that the mean of an integrand over the set is unbiased, and the
// spread over seeds is its error. Plain sets ignore the seed; `independent` points (Philox) need no
// randomisation.
class PointSet {
  public:
    struct Settings {
        PointSetKind kind = PointSetKind::sobol;
        int dimensions = 2; // at most 1024 (Hammersley 1025)
        std::uint32_t count = 1024;
        Randomisation randomisation = Randomisation::scramble;
        std::uint64_t seed = 0;
    };

    // Throws Error where the dimensions exceed what the kind has, or the randomisation does not exist for it.
    explicit PointSet(const Settings& settings);

    // Coordinate of a point; index < count, dimension < dimensions. Sobol' has 32 binary digits.
    double operator()(std::uint32_t index, int dimension) const;
    const Settings& settings() const { return settings_; }

  private:
    double unshifted(std::uint32_t index, int dimension) const;
    double halton(std::uint32_t index, int base, std::uint64_t key) const;

    Settings settings_;
    std::vector<std::uint64_t> keys_;  // one per dimension
    std::vector<std::uint64_t> steps_; // additive sequences: one per dimension
};

} // namespace montelux
