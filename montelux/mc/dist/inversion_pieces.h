// The pieces into which a numerical inversion cuts an interval.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace montelux {

// A piece of the line beside an `origin`, in a parameter t in (0, 1] whose grain gets finer towards t = 0.
// Near: x = origin + extent t, so that a singularity at the origin is resolved. Far: x = origin +
// extent (1/t - 1), which reaches infinity at t = 0. extent < 0 lies left of the origin.
struct InversionPiece {
    double origin, extent;
    bool far;

    double x(double t) const {
        if (far) return origin + extent * (1 / t - 1);
        double at = origin + extent * t;
        // f may be infinite at the origin itself, so that rounding must not lead there.
        if (at == origin && t > 0) [[unlikely]]
            return std::nextafter(origin, extent > 0 ? upper_limit : -upper_limit);
        return at;
    }
    double parameter(double x) const {
        double distance = (x - origin) / extent;
        return far ? 1 / (1 + distance) : distance;
    }
    // y |dx/dt|, for a density y at x(t); in an order that does not overflow before it must.
    double jacobian(double t, double y) const {
        double scaled = std::abs(extent) * y;
        return far && scaled > 0 ? scaled / t / t : scaled;
    }
    // Whether x rises with t.
    bool rising() const { return (extent > 0) != far; }
    // Whether the numbers between two parameters are still so many that its halves can be integrated.
    bool divisible(double from, double to) const {
        double width = std::abs(to - from), larger = std::max(from, to);
        if (!(width > 256 * std::numeric_limits<double>::epsilon() * larger && larger > 1e-290)) return false;
        return far ||
               width * std::abs(extent) > 256 * std::numeric_limits<double>::epsilon() * std::abs(origin);
    }
    // Panels (parameter of the left end, of the right end): 16 equal ones, the first of them graded.
    std::vector<std::pair<double, double>> first_panels() const;

    static constexpr double upper_limit = std::numeric_limits<double>::infinity();
};

// From left to right, with origins at finite ends, break points, and 0 where both ends are infinite and there
// are no break points. Throws Error unless a < b and the break points lie between them.
std::vector<InversionPiece> inversion_pieces(double a, double b, std::span<const double> break_points);

[[noreturn]] void throw_bad_density(double x, double y);
[[noreturn]] void throw_no_density(double a, double b);
[[noreturn]] void throw_not_integrable(double x);

} // namespace montelux
