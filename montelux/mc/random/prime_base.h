// The first primes, and division by them without a divide instruction.
#pragma once

#include <array>
#include <cstdint>

namespace montelux {

// A base with its reciprocal. Lemire, Kaser, Kurz 2019, "Faster remainder by direct computation": with
// reciprocal = ceil(2^64 / base) the quotient is exact for all 32-bit numerators.
struct PrimeBase {
    std::uint32_t base = 0;
    std::uint64_t reciprocal = 0;

    constexpr PrimeBase() = default;
    constexpr explicit PrimeBase(std::uint32_t b) : base(b), reciprocal(~std::uint64_t{0} / b + 1) {}

    constexpr std::uint32_t quotient(std::uint32_t x) const {
        __extension__ using Wide = unsigned __int128;
        return static_cast<std::uint32_t>((Wide{reciprocal} * x) >> 64);
    }
    constexpr std::uint32_t remainder(std::uint32_t x) const { return x - quotient(x) * base; }
};

inline constexpr int prime_count = 1024;

// 2, 3, 5, ... 8161, by the sieve of Eratosthenes.
inline constexpr std::array<PrimeBase, prime_count> prime_bases = [] {
    constexpr std::uint32_t limit = 8162;
    std::array<bool, limit> composite{};
    std::array<PrimeBase, prime_count> primes{};
    int found = 0;
    for (std::uint32_t p = 2; p < limit && found < prime_count; ++p) {
        if (composite[p]) continue;
        primes[found++] = PrimeBase(p);
        for (std::uint32_t q = p * p; q < limit; q += p) composite[q] = true;
    }
    return primes;
}();
static_assert(prime_bases[prime_count - 1].base == 8161);

} // namespace montelux
