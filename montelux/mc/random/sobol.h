// Sobol' sequence in up to 1024 dimensions.
#pragma once

#include <array>
#include <cstdint>

namespace montelux {

inline constexpr int sobol_dimensions = 1024;
inline constexpr int sobol_bits = 32;

// Columns of one dimension's generator matrix: bit k of an index toggles columns[k]; the top bit of a column
// is the first binary digit of the coordinate.
using SobolColumns = std::array<std::uint32_t, sobol_bits>;

// Generator matrix of a dimension in [0, 1024), built on first use. Direction numbers: Joe, Kuo 2008.
const SobolColumns& sobol_columns(int dimension);

// Coordinate of point `index` as a fraction of 2^32, in natural (not Gray code) order (Sobol' 1967). The
// first 2^m points, and every aligned block of 2^m, are a (t,m,s)-net in base 2.
constexpr std::uint32_t sobol_coordinate(std::uint32_t index, const SobolColumns& columns) {
    std::uint32_t x = 0;
    for (int k = 0; index != 0; index >>= 1, ++k) x ^= columns[k] & (0u - (index & 1u));
    return x;
}

// The first dimensions by four index bits at a time, results bit-reversed: bit 0 is the first digit. Their
// fixed size and constant initialisation suit the hottest loops.
inline constexpr int sobol_nibble_dimensions = 16;
using SobolNibbles = std::array<std::array<std::array<std::uint32_t, 16>, 8>, sobol_nibble_dimensions>;
extern const SobolNibbles sobol_nibbles;

inline std::uint32_t sobol_coordinate_reversed(std::uint32_t index, int dimension) {
    std::uint32_t x = 0;
    for (int position = 0; index != 0; index >>= 4, ++position)
        x ^= sobol_nibbles[dimension][position][index & 15u];
    return x;
}

// The second dimension without a table: its matrix is Pascal's triangle modulo 2, a tensor power of
// [1 1; 0 1], hence five masked shifts. Takes and gives numbers with the bits reversed with respect to
// sobol_coordinate, so that the result suits owen_scramble_reversed: bit 0 is the first digit.
constexpr std::uint32_t sobol_second_reversed(std::uint32_t index) {
    index ^= (index & 0xaaaaaaaau) >> 1;
    index ^= (index & 0xccccccccu) >> 2;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xff00ff00u) >> 8;
    return index ^ (index >> 16);
}
// The same for 64-bit indices; the first 32 digits are the low half.
constexpr std::uint64_t sobol_second_reversed(std::uint64_t index) {
    index ^= (index & 0xaaaaaaaaaaaaaaaau) >> 1;
    index ^= (index & 0xccccccccccccccccu) >> 2;
    index ^= (index & 0xf0f0f0f0f0f0f0f0u) >> 4;
    index ^= (index & 0xff00ff00ff00ff00u) >> 8;
    index ^= (index & 0xffff0000ffff0000u) >> 16;
    return index ^ (index >> 32);
}

} // namespace montelux
