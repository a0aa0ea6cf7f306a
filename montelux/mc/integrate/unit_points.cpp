#include "montelux/mc/integrate/unit_points.h"

#include <algorithm>
#include <array>
#include <bit>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/owen.h"
#include "montelux/mc/random/philox.h"

namespace montelux {
namespace {

// The middle of a cell of width 2^-52, whose number the low 52 bits are: the digits of a number in [1, 2),
// less one.
inline double unit_double(std::uint64_t digits) {
    return std::bit_cast<double>(digits | 0x3ff0000000000000u) - (1 - 0x1p-53);
}

constexpr std::size_t lanes = 64; // points that one pass of the loops below takes

// Of two 32-bit numbers that stand in 64-bit lanes, whose upper halves do not matter; all at once where the
// processor can.
inline void multiply(const std::uint64_t* x, std::uint64_t factor, std::uint64_t* product) {
#ifdef __AVX2__
    const __m256i f = _mm256_set1_epi64x(static_cast<long long>(factor));
    for (std::size_t i = 0; i < lanes; i += 4) {
        const __m256i v = _mm256_load_si256(reinterpret_cast<const __m256i*>(x + i));
        _mm256_store_si256(reinterpret_cast<__m256i*>(product + i), _mm256_mul_epu32(v, f));
    }
#else
    for (std::size_t i = 0; i < lanes; ++i) product[i] = (x[i] & 0xffffffffu) * factor;
#endif
}

} // namespace

void fill_random(PointBuffer& u, std::uint64_t seed, std::uint32_t stream, std::uint64_t first) {
    const std::uint64_t key = hash_key(seed, stream);
    const int dimensions = u.dimensions();
    for (std::size_t begin = 0; begin < u.count(); begin += lanes) {
        const std::size_t n = std::min(lanes, u.count() - begin);
        for (int group = 0; group * 4 < dimensions; ++group) {
            // philox4x32 with the points innermost; each word in the lower half of 64 bits, since products
            // need that.
            alignas(32) std::uint64_t c0[lanes], c1[lanes], c2[lanes], c3[lanes], p0[lanes], p1[lanes];
            for (std::size_t i = 0; i < lanes; ++i) {
                const std::uint64_t index = first + begin + i;
                c0[i] = index;
                c1[i] = index >> 32;
                c2[i] = static_cast<std::uint64_t>(group);
                c3[i] = stream;
            }
            std::uint32_t key0 = static_cast<std::uint32_t>(key),
                          key1 = static_cast<std::uint32_t>(key >> 32);
            for (int round = 0; round < 7; ++round) {
                multiply(c0, 0xd2511f53u, p0);
                multiply(c2, 0xcd9e8d57u, p1);
                for (std::size_t i = 0; i < lanes; ++i) {
                    c0[i] = (p1[i] >> 32) ^ c1[i] ^ key0;
                    c1[i] = p1[i];
                    c2[i] = (p0[i] >> 32) ^ c3[i] ^ key1;
                    c3[i] = p0[i];
                }
                key0 += 0x9e3779b9u;
                key1 += 0xbb67ae85u;
            }
            // The low digits of a coordinate come from the next word, which its high digits do not determine.
            const std::uint64_t* word[4] = {c0, c1, c2, c3};
            for (int j = 0; j < 4 && group * 4 + j < dimensions; ++j) {
                const std::uint64_t* high = word[j];
                multiply(word[(j + 1) & 3], 0x9e3779b9u, p0);
                double* out = u.coordinate(group * 4 + j).data() + begin;
                for (std::size_t i = 0; i < n; ++i)
                    out[i] = unit_double((high[i] & 0xffffffffu) << 20 | (p0[i] & 0xffffffffu) >> 12);
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
                const std::uint32_t low = (x ^ (x >> 15)) * 0x2c1b3c6du + key;
                out[begin + i] = unit_double(std::uint64_t{reverse_bits(x)} << 20 | low >> 12);
            }
            begin += n;
        }
    }
}

} // namespace montelux
