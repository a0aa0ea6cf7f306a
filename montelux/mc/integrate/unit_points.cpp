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

constexpr std::size_t lanes = 64; // points that one pass of the Sobol' loop takes

// Four 32-bit numbers, each in the lower half of 64 bits (the upper half is unused): their products need 64
// bits.
#ifdef __AVX2__
struct Lanes {
    __m256i v;

    static Lanes all(std::uint64_t x) { return {_mm256_set1_epi64x(static_cast<long long>(x))}; }
    static Lanes from(std::uint64_t x) { return {_mm256_add_epi64(all(x).v, _mm256_set_epi64x(3, 2, 1, 0))}; }
    Lanes times(Lanes y) const { return {_mm256_mul_epu32(v, y.v)}; }
    template <int n>
    Lanes right() const {
        return {_mm256_srli_epi64(v, n)};
    }
    template <int n>
    Lanes left() const {
        return {_mm256_slli_epi64(v, n)};
    }
    friend Lanes operator^(Lanes a, Lanes b) { return {_mm256_xor_si256(a.v, b.v)}; }
    friend Lanes operator&(Lanes a, Lanes b) { return {_mm256_and_si256(a.v, b.v)}; }
    friend Lanes operator|(Lanes a, Lanes b) { return {_mm256_or_si256(a.v, b.v)}; }
    // unit_double of each.
    void store_unit(double* out) const {
        const __m256d x = _mm256_castsi256_pd(_mm256_or_si256(v, all(0x3ff0000000000000u).v));
        _mm256_storeu_pd(out, _mm256_sub_pd(x, _mm256_set1_pd(1 - 0x1p-53)));
    }
};
#else
struct Lanes {
    std::uint64_t v[4];

    static Lanes all(std::uint64_t x) { return {{x, x, x, x}}; }
    static Lanes from(std::uint64_t x) { return {{x, x + 1, x + 2, x + 3}}; }
    template <typename F>
    static Lanes each(const F& f) {
        return {{f(0), f(1), f(2), f(3)}};
    }
    Lanes times(Lanes y) const {
        return each([&](int i) { return (v[i] & 0xffffffffu) * (y.v[i] & 0xffffffffu); });
    }
    template <int n>
    Lanes right() const {
        return each([&](int i) { return v[i] >> n; });
    }
    template <int n>
    Lanes left() const {
        return each([&](int i) { return v[i] << n; });
    }
    friend Lanes operator^(Lanes a, Lanes b) {
        return each([&](int i) { return a.v[i] ^ b.v[i]; });
    }
    friend Lanes operator&(Lanes a, Lanes b) {
        return each([&](int i) { return a.v[i] & b.v[i]; });
    }
    friend Lanes operator|(Lanes a, Lanes b) {
        return each([&](int i) { return a.v[i] | b.v[i]; });
    }
    void store_unit(double* out) const {
        for (int i = 0; i < 4; ++i) out[i] = unit_double(v[i]);
    }
};
#endif

// The keys of the rounds of Philox4x32-7 (Salmon et al. 2011, "Parallel Random Numbers: As Easy as 1, 2, 3").
struct RoundKeys {
    static constexpr int rounds = 7;
    Lanes low[rounds], high[rounds];

    explicit RoundKeys(std::uint64_t key) {
        std::uint32_t key0 = static_cast<std::uint32_t>(key), key1 = static_cast<std::uint32_t>(key >> 32);
        for (int round = 0; round < rounds; ++round) {
            low[round] = Lanes::all(key0);
            high[round] = Lanes::all(key1);
            key0 += 0x9e3779b9u;
            key1 += 0xbb67ae85u;
        }
    }
};

// Philox4x32-7 of consecutive points, whose state stays in registers: coordinates 4 * group and on. Several
// vectors are interleaved, since each round depends on the one before.
struct RandomBlock {
    static constexpr std::size_t vectors = 2, points = 4 * vectors;
    Lanes word[4][vectors];

    RandomBlock(std::uint64_t index, int group, std::uint32_t stream, const RoundKeys& keys) {
        auto& [c0, c1, c2, c3] = word;
        for (std::size_t k = 0; k < vectors; ++k) {
            c0[k] = Lanes::from(index + 4 * k);
            c1[k] = c0[k].right<32>();
            c2[k] = Lanes::all(static_cast<std::uint64_t>(group));
            c3[k] = Lanes::all(stream);
        }
        const Lanes m0 = Lanes::all(0xd2511f53u), m1 = Lanes::all(0xcd9e8d57u);
#pragma GCC unroll 7
        for (int round = 0; round < RoundKeys::rounds; ++round) {
#pragma GCC unroll 2
            for (std::size_t k = 0; k < vectors; ++k) {
                const Lanes p0 = c0[k].times(m0), p1 = c2[k].times(m1);
                c0[k] = p1.right<32>() ^ c1[k] ^ keys.low[round];
                c2[k] = p0.right<32>() ^ c3[k] ^ keys.high[round];
                c1[k] = p1;
                c3[k] = p0;
            }
        }
    }
    // The low digits of a coordinate come from the next word, which its high digits do not determine.
    void store(int j, double* out) const {
        for (std::size_t k = 0; k < vectors; ++k) {
            const Lanes low = word[(j + 1) & 3][k].times(Lanes::all(0x9e3779b9u));
            const Lanes digits = (word[j][k].left<20>() & Lanes::all(0x000ffffffff00000u)) |
                                 (low.right<12>() & Lanes::all(0xfffffu));
            digits.store_unit(out + 4 * k);
        }
    }
};

} // namespace

void fill_random(PointBuffer& u, std::uint64_t seed, std::uint32_t stream, std::uint64_t first) {
    constexpr std::size_t points = RandomBlock::points;
    const RoundKeys keys(hash_key(seed, stream));
    const int dimensions = u.dimensions();
    const std::size_t whole = u.count() / points * points;
    for (int group = 0; group * 4 < dimensions; ++group) {
        const int coordinates = std::min(4, dimensions - group * 4);
        double* out[4];
        for (int j = 0; j < coordinates; ++j) out[j] = u.coordinate(group * 4 + j).data();
        if (coordinates == 4)
            for (std::size_t i = 0; i < whole; i += points) {
                const RandomBlock block(first + i, group, stream, keys);
#pragma GCC unroll 4
                for (int j = 0; j < 4; ++j) block.store(j, out[j] + i);
            }
        else
            for (std::size_t i = 0; i < whole; i += points) {
                const RandomBlock block(first + i, group, stream, keys);
                for (int j = 0; j < coordinates; ++j) block.store(j, out[j] + i);
            }
        if (whole == u.count()) continue;
        const RandomBlock last(first + whole, group, stream, keys);
        for (int j = 0; j < coordinates; ++j) {
            double some[points];
            last.store(j, some);
            std::copy_n(some, u.count() - whole, out[j] + whole);
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
