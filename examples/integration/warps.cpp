// Triangles, discs and directions from the unit square. Two tests of each warp: a mean over its samples has
// the known value; and its density is a change of area, so that the integral of 1/p over a cell of the square
// is the area of the cell's image.
#include "comparison.h"
#include "known_warps.h"
#include <montelux/mc/integrate/basic_monte_carlo.h>
#include <montelux/mc/integrate/cubature/cubature.h>
#include <montelux/mc/integrate/integrate.h>
#include <span>
#include <vector>

using namespace montelux;
using Coordinates = std::span<const double>;

Vec3d point(Coordinates x) { return {x[0], x[1], x.size() > 2 ? x[2] : 0}; }

// The mean over samples, by integration over the square.
void compare_samples(Comparison& comparison, const Warp& warp) {
    const auto r = integrate(
        [&](Coordinates u) {
            return warp.value(warp.sample({u[0], u[1]}));
        },
        Domain::unit_cube(2), BasicMonteCarlo{}, {.evaluations = 100'000});
    comparison.add(warp.name + ": " + warp.quantity, r.estimate(), warp.mean);
}

// Points spread evenly over the plane or the sphere: some lie in the image of the cell.
void compare_areas(Comparison& comparison, const Warp& warp) {
    const Range x{0.1, 0.3}, y{0.4, 0.6};
    const auto in_image = [&](Coordinates at) {
        const Vec3d p = point(at);
        if (!(warp.pdf(p) > 0)) return 0.0;
        const Vec2d u = warp.inverse(p);
        return u.x >= x.lower && u.x < x.upper && u.y >= y.lower && u.y < y.upper ? 1.0 : 0.0;
    };
    const auto area = integrate(in_image, warp.around, BasicMonteCarlo{}, {.evaluations = 1'000'000});
    const auto stretched = integrate(
        [&](Coordinates u) {
            return 1 / warp.pdf(warp.sample({u[0], u[1]}));
        },
        Domain{x, y}, Cubature{}, {.relative_error = 1e-8});
    comparison.add(warp.name + ": area of a warped cell", area.estimate(), stretched.value[0]);
}

int main() {
    Comparison comparison(4); // wider, since one of this many comparisons would sometimes exceed three errors
    const std::vector<Warp> warps = all_warps();
    std::cout << "Means over samples\n";
    for (const Warp& warp : warps) compare_samples(comparison, warp);
    std::cout << "\nAreas of a cell's image, counted, beside the integral of 1/p over the cell\n";
    for (const Warp& warp : warps) compare_areas(comparison, warp);
    return comparison.exit_code();
}
