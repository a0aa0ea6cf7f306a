// Number types: what formulas ask of them, so that they are written once for one path and for many.
#pragma once

#include <concepts>
#include <cstdint>

namespace montelux {

// Formulas on the way of a sample are templates over a number type T: float for one path, Lanes<W> (lanes.h)
// for W paths at a time. Comparisons give a MaskOf<T>, and `select` takes the place of branches. Calls of
// sqrt, abs, min, max, copysign are unqualified after `using std::sqrt`, so that those of Lanes are found.
template <typename T>
struct NumberTraits {
    using Scalar = T;
    using Mask = bool;
    using Bits = std::uint32_t;
    static constexpr int lanes = 1;
};
template <typename T>
concept LaneNumber = (NumberTraits<T>::lanes > 1);
template <typename T>
concept Number = std::floating_point<T> || LaneNumber<T>;
template <Number T>
using ScalarOf = typename NumberTraits<T>::Scalar; // of one lane
template <Number T>
using MaskOf = typename NumberTraits<T>::Mask;
template <Number T>
using BitsOf = typename NumberTraits<T>::Bits;

// `condition ? a : b` in each lane; both are computed.
template <typename T>
constexpr T select(bool condition, T a, T b) {
    return condition ? a : b;
}
// Whether the condition holds in some lane, in every lane.
constexpr bool any(bool condition) { return condition; }
constexpr bool all(bool condition) { return condition; }

// The high and the low word of a product.
template <typename Bits>
struct WideProduct {
    Bits high, low;
};
constexpr WideProduct<std::uint32_t> wide_product(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t product = std::uint64_t{a} * b;
    return {static_cast<std::uint32_t>(product >> 32), static_cast<std::uint32_t>(product)};
}

} // namespace montelux
