// The equiangular density on a segment of a line: equal angles as seen from a point beside it.
#pragma once

#include <cmath>
#include <concepts>

namespace montelux {

// Kulla & Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media", section 4:
// a Cauchy density about the point's foot on the line, conditioned on the segment. It follows the inverse square
// of the distance to the point.
template <std::floating_point T>
struct Equiangular {
    T foot;     // the point's projection, by its distance from the start; may be outside the segment
    T distance; // of the point from the line; above 0
    T length;   // of the segment; may be infinite

    T angle_of(T x) const { return std::atan((x - foot) / distance); }
    T first_angle() const { return angle_of(0); }
    T all_angles() const { return angle_of(length) - first_angle(); }

    // Per length, for x in [0, length].
    T pdf(T x) const {
        if (!(x >= 0 && x <= length)) return 0;
        const T y = (x - foot) / distance;
        return 1 / (all_angles() * distance * (1 + y * y));
    }
    // u in [0, 1).
    T sample(T u) const {
        const T x = foot + distance * std::tan(first_angle() + u * all_angles());
        return x < 0 ? T(0) : x < length ? x : length;
    }
    T invert(T x) const { return (angle_of(x) - first_angle()) / all_angles(); }
};

} // namespace montelux
