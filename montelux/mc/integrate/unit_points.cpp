#include "montelux/mc/integrate/unit_points.h"

#include <algorithm>
#include <array>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/owen.h"
#include "montelux/mc/random/philox.h"

namespace montelux {
namespace {

// The middle of a cell of width 2^-52: 32 digits from `high`, 20 from `low`.
inline double unit_double(std::uint32_t high, std::uint32_t low) {
    // Both conversions are of signed numbers, which vectorise.
    double h = static_cast<double>(static_cast<std::int32_t>(high ^ 0x80000000u)) + 0x1p31;
    double l = static_cast<double>(static_cast<std::int32_t>(low >> 12)) + 0.5;
    return (h + l * 0x1p-20) * 0x1p-32;
}

constexpr std::size_t lanes = 64; // points that one pass of the loops below takes

} // namespace

void fill_random(PointBuffer& u, std::uint64_t seed, std::uint32_t stream, std::uint64_t first) {
    const std::uint64_t key = hash_key(seed, stream);
    const auto key0 = static_cast<std::uint32_t>(key), key1 = static_cast<std::uint32_t>(key >> 32);
    const int dimensions = u.dimensions();
    for (std::size_t begin = 0; begin < u.count(); begin += lanes) {
        const std::size_t n = std::min(lanes, u.count() - begin);
        for (int group = 0; group * 4 < dimensions; ++group) {
            // philox4x32 with the lanes innermost, so that the compiler vectorises over points.
            std::uint32_t c0[lanes], c1[lanes], c2[lanes], c3[lanes];
            for (std::size_t i = 0; i < lanes; ++i) {
                std::uint64_t index = first + begin + i;
                c0[i] = static_cast<std::uint32_t>(index);
                c1[i] = static_cast<std::uint32_t>(index >> 32);
                c2[i] = static_cast<std::uint32_t>(group);
                c3[i] = stream;
            }
            for (std::size_t i = 0; i < lanes; ++i) {
                const auto block = philox4x32<>({c0[i], c1[i], c2[i], c3[i]}, {key0, key1});
                c0[i] = block[0];
                c1[i] = block[1];
                c2[i] = block[2];
                c3[i] = block[3];
            }
            // The low digits of a coordinate come from the next word, which its high digits do not determine.
            const std::uint32_t* word[4] = {c0, c1, c2, c3};
            for (int j = 0; j < 4 && group * 4 + j < dimensions; ++j) {
                const std::uint32_t* high = word[j];
                const std::uint32_t* next = word[(j + 1) & 3];
                double* out = u.coordinate(group * 4 + j).data() + begin;
                for (std::size_t i = 0; i < n; ++i) out[i] = unit_double(high[i], next[i] * 0x9e3779b9u);
            }
        }
    }
}

ScrambledSobol::ScrambledSobol(int dimensions, std::uint64_t seed, std::uint32_t replicate) {
    if (dimensions > sobol_dimensions)
        throw Error("Sobol' points", "expected at most " + std::to_string(sobol_dimensions) +
                                         " dimensions, got " + std::to_string(dimensions));
    for (int d = 0; d < dimensions; ++d) {
        keys_.push_back(static_cast<std::uint32_t>(hash_key(seed, replicate, d)));
        for (std::uint32_t column : sobol_columns(d)) columns_.push_back(reverse_bits(column));
    }
}

void ScrambledSobol::fill(PointBuffer& u, std::uint64_t first) const {
    for (std::size_t d = 0; d < keys_.size(); ++d) {
        const std::uint32_t* columns = &columns_[d * sobol_bits];
        const std::uint32_t key = keys_[d];
        double* out = u.coordinate(static_cast<int>(d)).data();
        auto coordinate = [&](std::uint64_t index) {
            std::uint32_t x = 0;
            for (int k = 0; index != 0; index >>= 1, ++k)
                x ^= columns[k] & (0u - static_cast<std::uint32_t>(index & 1u));
            return x;
        };
        // Within an aligned run of `lanes` points the low index bits give the same pattern each time.
        std::uint32_t pattern[lanes];
        for (std::size_t i = 0; i < lanes; ++i) pattern[i] = coordinate(i);
        for (std::size_t begin = 0; begin < u.count();) {
            const std::uint64_t index = first + begin;
            const std::size_t offset = index % lanes;
            const std::size_t n = std::min(lanes - offset, u.count() - begin);
            const std::uint32_t base = coordinate(index - offset);
            for (std::size_t i = 0; i < n; ++i) {
                const std::uint32_t x = owen_scramble_reversed(base ^ pattern[offset + i], key);
                out[begin + i] = unit_double(reverse_bits(x), (x ^ (x >> 15)) * 0x2c1b3c6du + key);
            }
            begin += n;
        }
    }
}

} // namespace montelux
