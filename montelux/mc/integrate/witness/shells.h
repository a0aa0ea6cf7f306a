// Dyadic shells around a point: does the mass of |g| fall towards it?
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/infinity.h"

namespace montelux {

// Exponents of the smallest distances that a look takes: inside of the cube, and from an end that is the origin, where
// doubles are denser; squares of such distances are still doubles.
inline constexpr double finest_inside = 46, finest_at_origin = 400;
// Factor of all distances of looks: integrands have features at powers of two.
inline constexpr double off_grid = 0.9;
// Distance from u to the end of the cube on a side.
inline double reach(double u, double side) { return side > 0 ? 1 - u : u; }
// Exponent of the smallest distance around coordinate d = u of the unit cube that is far above the spacing of doubles, in
// u and in x.
double finest_exponent(const Domain& domain, std::size_t d, double u);

// |g| at distances 2^-k from a point, k one of the exponents; infinite where g is, NaN where it is not a number.
using ShellValues = std::function<std::vector<double>(std::span<const double> exponents)>;

// Mass of a shell at distance r = 2^-k is |g| r^codimension. Its sum over k converges if the masses fall faster
// than 1 / k (Cauchy's condensation of the integral): compares their mean over the inner shells, up to `finest`,
// with that over shells of half their exponents, where 1 / k gives a ratio of a half. True where they do not fall.
// Where inner values are infinite, zero or not numbers, by overflow or rounding, coarser shells decide. Values that end
// in truth have no mass beyond; `overflows`: zeros beyond 2^-64 are not such ends, but quotients by an infinite number.
// Where cancellation makes inner values noise or zero, the power that they followed before decides, up to the exponent
// `until`.
bool masses_diverge(const ShellValues& values, double finest, int codimension, bool overflows = false,
                    double until = infinity);

} // namespace montelux
