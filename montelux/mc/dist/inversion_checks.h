// Checks of a density and its antiderivative before they are sampled.
#pragma once

namespace montelux {

// Names the source of an inversion's errors.
inline constexpr const char* inversion_errors = "inversion of a density";

// Each require_* throws Error with a sentence.
void require_interval(double a, double b);
void require_growth(double a, double at_a, double b, double at_b);
// The point at fraction t of [a, b], 0 < t < 1; an infinite side is counted by 1/t.
double point_inside(double a, double b, double t);
// f(x) is not negative, and F(x) lies between F(a) and F(b).
void require_rising(double x, double density, double value, double at_a, double at_b);
// f(x) is a density, and F(x) is the `target` that x was made for, to 1e-6 of the whole integral.
void require_antiderivative(double x, double density, double value, double target, double integral);
[[noreturn]] void throw_wrong_slope(double x, double slope, double density);

} // namespace montelux
