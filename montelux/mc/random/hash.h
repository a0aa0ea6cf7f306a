// Mixing hashes: keys that look random from coordinates that do not.
#pragma once

#include <cstdint>

namespace montelux {

// Bijection on 64 bits whose every output bit depends on every input bit: the finaliser "Mix13" of
// Stafford 2011 that SplitMix64 uses (Steele, Lea, Flood 2014, "Fast Splittable Pseudorandom Number
// Generators").
constexpr std::uint64_t mix64(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

// The same on 32 bits: the two-round function of least bias that Wellons found by search (2018,
// "hash-prospector").
constexpr std::uint32_t mix32(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

// 2^64 divided by the golden ratio, made odd: the increment of SplitMix64.
inline constexpr std::uint64_t golden_gamma = 0x9e3779b97f4a7c15u;

// Key of a sequence of integers; the order matters, and so does their number.
constexpr std::uint64_t hash_key(std::uint64_t first) { return mix64(first + golden_gamma); }
template <typename... Rest>
constexpr std::uint64_t hash_key(std::uint64_t first, std::uint64_t second, Rest... rest) {
    return hash_key(hash_key(first) ^ second, static_cast<std::uint64_t>(rest)...);
}

} // namespace montelux
