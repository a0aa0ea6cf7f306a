// RandomStream: the numbers in [0, 1) that one sample is computed from, drawn one or two at a time.
#pragma once

#include <concepts>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Whatever is computed from a stream is a function of its numbers alone, so that another stream (a point of
// primary sample space, say) may drive it as well.
template <typename S>
concept RandomStream = requires(S& stream, float u) {
    { stream.next_1d() } -> std::same_as<float>;
    // Stratified in the plane where the stream is.
    { stream.next_2d() } -> std::same_as<Vec2f>;
    // The number u that was drawn last, with more digits below its 24 bits.
    { stream.refined(u) } -> std::same_as<double>;
};

} // namespace montelux
