// Digits that cancellation loses in the shells around a point: there values are noise, and at last zero.
#pragma once

#include "montelux/mc/integrate/witness/shells.h"

namespace montelux {

// The largest exponent between two whose value is a number above a floor, that value, and the one beyond it, for values that
// have none from there on.
struct LastValue {
    double exponent, value, beyond;
};
LastValue last_value(const ShellValues& values, double from, double to, double floor = 0,
                     int bisections = 12);

// Exponent from which on values are noise, as those of exp r - 1 - r are: as rough between near points as between those at
// 64 times the distance, where an oscillation is smooth, and smooth farther out. Infinite if there is none up to `finest`.
double noise_from(const ShellValues& values, double finest);

// Exponent from which on values have lost their digits: `last`, that of the last value, if cancellation rounds a term to zero
// beyond it, else that of noise. Infinite where values have their digits, or end in truth.
double digits_lost_from(const ShellValues& values, double last);

// Exponent beyond that of cancellations, where powers are still doubles.
inline constexpr double beyond_digits = 120;
// Part of the last exponent at which values are precise to 10 digits.
inline constexpr double precise = 0.8;

// Integral of |g| beyond the exponent where values have lost their digits, in units of the volume at exponent 0, by the
// power that they followed before, up to the exponent `until`. Infinite where the masses do not fall and have no end.
double mass_beyond(const ShellValues& values, double last, int codimension, double until = infinity);

// Mass beyond the place between two exponents where values that grow from the first one end, or drop to those of another
// term, by rounding to zero, up to the exponent `until`; 0 if there is none.
double mass_of_lost_digits(const ShellValues& values, double from, double to, int codimension,
                           double until = infinity);

} // namespace montelux
