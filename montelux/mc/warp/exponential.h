// The exponential density on [0, infinity): free paths in a homogeneous medium.
#pragma once

#include <cmath>
#include <concepts>

namespace montelux {

// Density rate e^(-rate x), rate > 0.
template <std::floating_point T>
T exponential_pdf(T x, T rate) {
    return x >= 0 ? rate * std::exp(-rate * x) : T(0);
}
// X = -ln(1 - u) / rate; u in [0, 1). log1p keeps the digits of small u, and so of short paths.
template <std::floating_point T>
T sample_exponential(T u, T rate) {
    return -std::log1p(-u) / rate;
}
template <std::floating_point T>
T invert_exponential(T x, T rate) {
    return -std::expm1(-rate * x);
}

// The same conditioned on x < length: a collision within a segment.
template <std::floating_point T>
T truncated_exponential_pdf(T x, T rate, T length) {
    if (!(x >= 0 && x < length)) return 0;
    return rate * std::exp(-rate * x) / -std::expm1(-rate * length);
}
template <std::floating_point T>
T sample_truncated_exponential(T u, T rate, T length) {
    T x = -std::log1p(u * std::expm1(-rate * length)) / rate;
    return x < length ? x : length;
}
template <std::floating_point T>
T invert_truncated_exponential(T x, T rate, T length) {
    return std::expm1(-rate * x) / std::expm1(-rate * length);
}

} // namespace montelux
