// The scrambled Sobol' points of randomised quasi-Monte Carlo.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/owen.h"
#include "montelux/mc/random/sobol.h"

namespace montelux {

// A point set for randomised_quasi_monte_carlo: point i of the Sobol' sequence, each dimension under an Owen
// scramble of its own for each replicate. Points come as multiples of 2^-32, moved by half of one off the
// edges of the cube. Powers of two of points suit it best; at most 2^32 of them.
template <std::size_t D>
class ScrambledSobolPoints {
  public:
    explicit ScrambledSobolPoints(std::uint64_t seed) : seed_(seed) {
        static_assert(D >= 1 && D <= static_cast<std::size_t>(sobol_dimensions));
        for (std::size_t d = 0; d < D; ++d) columns_[d] = sobol_columns(static_cast<int>(d));
    }

    std::array<double, D> operator()(std::uint64_t index, std::uint32_t replicate) const {
        std::array<double, D> point;
        for (std::size_t d = 0; d < D; ++d) {
            std::uint32_t x = sobol_coordinate(static_cast<std::uint32_t>(index), columns_[d]);
            auto key = static_cast<std::uint32_t>(hash_key(seed_, replicate, d));
            point[d] = (owen_scramble(x, key) + 0.5) * 0x1p-32;
        }
        return point;
    }

  private:
    std::uint64_t seed_;
    std::array<SobolColumns, D> columns_;
};

} // namespace montelux
