#include "montelux/mc/dist/inversion_checks.h"

#include <cmath>
#include <sstream>

#include "montelux/mc/dist/inversion_pieces.h"
#include "montelux/mc/math/error.h"

namespace montelux {
void require_interval(double a, double b) {
    if (a < b) return;
    std::ostringstream what;
    what << "the interval [" << a << ", " << b << "] is empty; expected a < b";
    throw Error(inversion_errors, what.str());
}

void require_growth(double a, double at_a, double b, double at_b) {
    if (at_b - at_a > 0 && std::isfinite(at_b - at_a)) return;
    std::ostringstream what;
    what << "the antiderivative is " << at_a << " at " << a << " and " << at_b << " at " << b
         << "; expected finite values that grow (at an infinite end, the limit)";
    throw Error(inversion_errors, what.str());
}

double point_inside(double a, double b, double t) {
    if (std::isfinite(a)) return std::isfinite(b) ? a + t * (b - a) : a + t / (1 - t);
    return std::isfinite(b) ? b - (1 - t) / t : (2 * t - 1) / (t * (1 - t));
}

void require_rising(double x, double density, double value, double at_a, double at_b) {
    if (!(density >= 0)) throw_bad_density(x, density);
    double slack = 1e-9 * (at_b - at_a);
    if (value >= at_a - slack && value <= at_b + slack) return;
    std::ostringstream what;
    what << "the antiderivative is " << value << " at x = " << x << ", and " << at_a << " and " << at_b
         << " at the ends; expected one that does not fall";
    throw Error(inversion_errors, what.str());
}

void require_antiderivative(double x, double density, double value, double target, double integral) {
    if (!(density >= 0)) throw_bad_density(x, density);
    if (std::isfinite(x) && std::abs(value - target) <= 1e-6 * integral) return;
    std::ostringstream what;
    what << "the antiderivative is " << value << " at x = " << x << ", which its inverse gave for " << target
         << "; expected a continuous antiderivative that does not fall, and its own inverse";
    throw Error(inversion_errors, what.str());
}

void throw_wrong_slope(double x, double slope, double density) {
    std::ostringstream what;
    what << "the antiderivative rises by " << slope << " per unit at x = " << x << ", where the density is "
         << density << "; expected one whose derivative is the density";
    throw Error(inversion_errors, what.str());
}

} // namespace montelux
