// Peaks around witnesses: their widths, and whether samples can have seen them.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/witness/largest_values.h"
#include "montelux/mc/integrate/witness/raw_values.h"

namespace montelux {

// One number for a row of components.
using Magnitude = std::function<double(const std::vector<double>& values)>;

// The greatest value at distances of all scales, along one variable after the other: 26 n evaluations.
Witness climb(RawValues& raw, Witness top, const Magnitude& magnitude);
// Measures the extents of a peak and its volume, the box within which the magnitude stays above a half, by bisection of
// the exponents of the distances on each side to within one: 12 n evaluations, a few more where the top is close to the
// origin of the cube. `finer`: further bisections.
void measure(RawValues& raw, Witness& top, const Magnitude& magnitude, int finer = 0);

// Tells a value that only a few neighbouring numbers have, as where a pole's distance is rounded to zero, from a peak.
bool is_rounding(const Witness& top);

// Whether a point belongs to a peak: the magnitude stays up along the line from it to the top.
bool belongs(RawValues& raw, const Witness& w, const Witness& top, const Magnitude& magnitude);

// Peaks of like height at the other end of a variable close to whose one end a peak lies, measured: the ends of an angle
// are one place.
std::vector<Witness> opposite_peaks(RawValues& raw, const Witness& peak, const Magnitude& magnitude);

// Lower bound on the integral of |g| over a peak of this value that points of density q have hardly seen: fewer than
// eight of `points` are expected within its volume, although the weight |g| / q there is far above `size`, the
// integral of |g| as claimed. 0 where the points explain the peak.
double unexplained(double value, double volume, double q, double points, double size);

} // namespace montelux
