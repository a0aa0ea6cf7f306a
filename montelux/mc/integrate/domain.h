// Domains of integration: regions of space as maps from the unit cube, with the change of volume.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/points.h"

namespace montelux {

// One variable's range; either end may be infinite.
struct Range {
    double lower = 0, upper = 1;
};

// A region D with a map x(u) from the unit cube onto it, and the factor |dx/du| by which the map changes
// volume, so that the integral of f over D is the integral of f(x(u)) |dx/du| over the cube. The number of
// uniform variables u may differ from the number of coordinates x (a sphere in three dimensions takes two).
class Domain {
  public:
    // x(u) for a batch: fills x (as many points as u), and multiplies `volume[i]` by |dx/du| at point i.
    using BatchMap = std::function<void(const PointBatch& u, PointBuffer& x, std::span<double> volume)>;
    // x(u) for one point: fills x and returns |dx/du|.
    using PointMap = std::function<double(std::span<const double> u, std::span<double> x)>;

    // The box of these ranges. Half-infinite ranges are mapped by x = a +- u / (1 - u), doubly infinite ones
    // by x = 1 / (1 - u) - 1 / u, which keep integrands that fall like 1/x^2 bounded. Throws Error for a
    // range that is reversed, empty or NaN, and for no range at all.
    Domain(std::vector<Range> ranges);
    Domain(std::initializer_list<Range> ranges) : Domain(std::vector<Range>(ranges)) {}
    static Domain interval(double lower, double upper) { return Domain({{lower, upper}}); }
    static Domain unit_cube(int dimensions);

    // x_j >= 0 with sum <= 1; the measure is volume (1 / n! in total).
    static Domain simplex(int dimensions);
    // |x - centre| <= radius; volume.
    static Domain ball(std::vector<double> centre, double radius = 1);
    // |x - centre| = radius in dimensions >= 2; the measure is the surface's area.
    static Domain sphere(std::vector<double> centre, double radius = 1);
    // A user's map from the unit cube; `description` names it in results.
    static Domain mapped(int uniforms, int dimensions, PointMap map, std::string description = "mapped");
    static Domain mapped_batch(int uniforms, int dimensions, BatchMap map,
                               std::string description = "mapped");
    // Points whose coordinates are those of `a`, then those of `b`.
    static Domain product(const Domain& a, const Domain& b);
    // The domain with names for its coordinates, which messages use. Throws Error where their number differs.
    Domain named(std::vector<std::string> names) const;

    // Coordinates of a point x.
    int dimensions() const;
    // Variables u that the map takes.
    int uniforms() const;
    // The ranges where the domain is a box, else empty.
    std::span<const Range> ranges() const;
    const std::string& description() const;
    // Name of coordinate d: "x" of one, "x1", "x2", ... of several that have no names.
    std::string name(int d) const;
    // The unit cube itself: x = u.
    bool is_unit_cube() const;
    // Constant |dx/du|, where it is constant (a finite box), else 0.
    double constant_volume() const;

    void map(const PointBatch& u, PointBuffer& x, std::span<double> volume) const;
    // u(x) for a batch of points of a box; multiplies `volume[i]` by |dx/du| there. Outside of the box u is
    // outside of (0, 1) or NaN. Throws Error where the domain is no box.
    void inverse(const PointBatch& x, PointBuffer& u, std::span<double> volume) const;

  private:
    struct Implementation;
    explicit Domain(std::shared_ptr<const Implementation> implementation);
    std::shared_ptr<const Implementation> implementation_;
};

} // namespace montelux
