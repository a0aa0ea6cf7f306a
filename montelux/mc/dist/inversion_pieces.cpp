#include "montelux/mc/dist/inversion_pieces.h"

#include <algorithm>
#include <sstream>

#include "montelux/mc/dist/inversion_checks.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {} // namespace

std::vector<std::pair<double, double>> InversionPiece::first_panels() const {
    constexpr int equal = 16, grades = 12;
    std::vector<double> edges{0};
    for (int k = grades; k > 0; --k) edges.push_back(std::ldexp(1.0 / equal, -2 * k));
    for (int i = 1; i <= equal; ++i) edges.push_back(static_cast<double>(i) / equal);
    std::vector<std::pair<double, double>> panels;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        std::pair panel(edges[i], edges[i + 1]);
        if (!rising()) std::swap(panel.first, panel.second);
        panels.push_back(panel);
    }
    return panels;
}

std::vector<InversionPiece> inversion_pieces(double a, double b, std::span<const double> break_points) {
    require_interval(a, b);
    std::vector<double> edges;
    for (double x : break_points) {
        if (!(x >= a && x <= b && std::isfinite(x))) {
            std::ostringstream what;
            what << "the break point " << x << " is not in [" << a << ", " << b << "]";
            throw Error(inversion_errors, what.str());
        }
        edges.push_back(x);
    }
    if (std::isfinite(a)) edges.push_back(a);
    if (std::isfinite(b)) edges.push_back(b);
    if (edges.empty()) edges.push_back(0);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    // Where an outer piece meets the one that reaches infinity; any scale is found from there.
    auto reach = [](double x) { return std::max(1.0, 1e-6 * std::abs(x)); };

    std::vector<InversionPiece> pieces;
    if (std::isinf(a)) {
        double end = edges.front(), step = reach(end);
        pieces.push_back({end - step, -step, true});
        pieces.push_back({end, -step, false});
    }
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        double half = 0.5 * edges[i + 1] - 0.5 * edges[i];
        if (!std::isfinite(half))
            throw Error(inversion_errors, "the interval is wider than the largest number");
        pieces.push_back({edges[i], half, false});
        pieces.push_back({edges[i + 1], -half, false});
    }
    if (std::isinf(b)) {
        double end = edges.back(), step = reach(end);
        pieces.push_back({end, step, false});
        pieces.push_back({end + step, step, true});
    }
    return pieces;
}

void throw_bad_density(double x, double y) {
    std::ostringstream what;
    what << "the function is " << y << " at x = " << x << "; expected a finite number that is not negative";
    if (y > 0) what << " (where it is infinite but integrable, give a break point)";
    throw Error(inversion_errors, what.str());
}
void throw_no_density(double a, double b) {
    std::ostringstream what;
    what << "the function is zero wherever it was asked on [" << a << ", " << b
         << "], so it has no density; a narrow peak needs a break point in it";
    throw Error(inversion_errors, what.str());
}
void throw_not_integrable(double x) {
    std::ostringstream what;
    what << "the integral of the function does not settle near x = " << x
         << ": it is not integrable there, or needs a break point, or is so steep that numbers near x are "
            "too far "
            "apart (move that point to 0)";
    throw Error(inversion_errors, what.str());
}

} // namespace montelux
