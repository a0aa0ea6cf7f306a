// Radical inverses: the van der Corput sequence in any base, plain and with scrambled digits.
#pragma once

#include <algorithm>
#include <cstdint>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/owen.h"
#include "montelux/mc/random/prime_base.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {

// Mirrors the digits of `index` at the radix point (van der Corput 1935): in [0, 1).
constexpr double radical_inverse(std::uint32_t index, const PrimeBase& base) {
    if (base.base == 2) return unit_double(reverse_bits(index));
    std::uint64_t digits = 0, scale = 1;
    while (index != 0) {
        const std::uint32_t rest = base.quotient(index);
        digits = digits * base.base + (index - rest * base.base);
        scale *= base.base;
        index = rest;
    }
    return std::min(static_cast<double>(digits) / static_cast<double>(scale), one_minus_epsilon_d);
}

// The same with one fixed digit permutation at every place (Faure, Lemieux 2009, "Generalized Halton
// sequences"): digit -> multiplier * digit modulo the base, which fixes 0. 0 < multiplier < base.
constexpr double permuted_radical_inverse(std::uint32_t index, const PrimeBase& base,
                                          std::uint32_t multiplier) {
    std::uint64_t digits = 0, scale = 1;
    while (index != 0) {
        const std::uint32_t rest = base.quotient(index);
        digits = digits * base.base + base.remainder((index - rest * base.base) * multiplier);
        scale *= base.base;
        index = rest;
    }
    return std::min(static_cast<double>(digits) / static_cast<double>(scale), one_minus_epsilon_d);
}

// Nested scrambling of the digits of indices below `count` (Owen 1995): uniform on [0, 1) over keys, exact
// strata kept. Every digit goes through d -> (a d + c) mod base with a, c hashed from the digits before it.
// Such permutations are pairwise as random as all permutations, which is all that the variance of a scrambled
// net depends on (Matousek 1998, "On the L2-discrepancy for anchored boxes", section 2). Beyond the digits
// that distinguish indices below `count`, a full scramble is independent noise, and is drawn as such.
constexpr double scrambled_radical_inverse(std::uint32_t index, const PrimeBase& base, std::uint64_t key,
                                           std::uint32_t count) {
    const std::uint32_t b = base.base;
    std::uint64_t digits = 0, scale = 1, prefix = 0;
    while (scale < count) {
        const std::uint64_t h = mix64(key ^ (prefix + scale) * golden_gamma);
        const std::uint32_t a = 1 + bounded(static_cast<std::uint32_t>(h), b - 1);
        const std::uint32_t c = bounded(static_cast<std::uint32_t>(h >> 32), b);
        const std::uint32_t rest = base.quotient(index);
        const std::uint32_t digit = index - rest * b;
        digits = digits * b + base.remainder(a * digit + c);
        prefix += digit * scale;
        scale *= b;
        index = rest;
    }
    const double noise = unit_double(mix64(key ^ (prefix + scale) * golden_gamma));
    return std::min((static_cast<double>(digits) + noise) / static_cast<double>(scale), one_minus_epsilon_d);
}

} // namespace montelux
