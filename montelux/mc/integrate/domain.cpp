#include "montelux/mc/integrate/domain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"

namespace montelux {

struct Domain::Implementation {
    int dimensions = 0, uniforms = 0;
    std::vector<Range> ranges;
    std::vector<std::string> names;
    std::string description;
    double constant_volume = 0;
    bool unit_cube = false;
    BatchMap map;
};

namespace {

// x in the range, and the factor by which u is stretched there.
void map_range(const Range& range, std::span<const double> u, std::span<double> x, std::span<double> volume) {
    const bool from = std::isfinite(range.lower), to = std::isfinite(range.upper);
    for (std::size_t i = 0; i < u.size(); ++i) {
        const double v = u[i], w = 1 - v;
        if (from && to) {
            x[i] = range.lower + (range.upper - range.lower) * v;
            volume[i] *= range.upper - range.lower;
        } else if (from) {
            x[i] = range.lower + v / w;
            volume[i] /= w * w;
        } else if (to) {
            x[i] = range.upper - w / v;
            volume[i] /= v * v;
        } else {
            x[i] = 1 / w - 1 / v;
            volume[i] *= 1 / (w * w) + 1 / (v * v);
        }
    }
}

// u(x), and the same factor.
void unmap_range(const Range& range, std::span<const double> x, std::span<double> u,
                 std::span<double> volume) {
    const bool from = std::isfinite(range.lower), to = std::isfinite(range.upper);
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (from && to) {
            u[i] = (x[i] - range.lower) / (range.upper - range.lower);
            volume[i] *= range.upper - range.lower;
        } else if (from || to) {
            const double t = from ? x[i] - range.lower : range.upper - x[i]; // v / (1 - v) of v = u, or 1 - u
            u[i] = t < 0 ? -1 : (from ? t : 1) / (1 + t);
            volume[i] *= (1 + t) * (1 + t);
        } else {
            // The root of x u^2 + (2 - x) u - 1 = 0 in (0, 1), of |x| and mirrored, so that nothing cancels.
            const double size = std::abs(x[i]), q = 2 / (std::sqrt(size * size + 4) + size);
            const double near = 1 / (1 + q), far = q / (1 + q);
            u[i] = x[i] < 0 ? far : near;
            volume[i] *= 1 / (near * near) + 1 / (far * far);
        }
    }
}

void check(const Range& range, std::size_t index) {
    std::ostringstream what;
    what << "range " << index + 1 << " is [" << range.lower << ", " << range.upper << "]; expected ";
    if (std::isnan(range.lower) || std::isnan(range.upper))
        throw Error("Domain", what.str() + "two numbers or infinities");
    if (!(range.lower < range.upper)) throw Error("Domain", what.str() + "a lower end below the upper one");
    if (std::isfinite(range.lower) && std::isfinite(range.upper) && !std::isfinite(range.upper - range.lower))
        throw Error("Domain", what.str() + "a width that is a finite number");
}

void check_dimensions(const char* what, int dimensions, int least) {
    if (dimensions < least)
        throw Error(what, "expected at least " + std::to_string(least) + " dimensions, got " +
                              std::to_string(dimensions));
}

void check_sphere(const char* what, const std::vector<double>& centre, double radius, int least) {
    check_dimensions(what, static_cast<int>(centre.size()), least);
    for (double c : centre)
        if (!std::isfinite(c)) throw Error(what, "expected a centre of finite numbers");
    if (!(radius > 0 && std::isfinite(radius))) throw Error(what, "expected a finite radius above zero");
}

// Volumes underflow or overflow in many dimensions.
double checked_volume(const char* what, int dimensions, double volume) {
    if (volume >= std::numeric_limits<double>::min() && std::isfinite(volume)) return volume;
    throw Error(what, "the volume in " + std::to_string(dimensions) + " dimensions is too " +
                          (volume < 1 ? "small" : "large") + " for double precision");
}

// Area of the unit sphere in n dimensions, 2 pi^(n/2) / Gamma(n/2).
double sphere_area(int n) { return 2 * std::exp(0.5 * n * std::log(pi) - std::lgamma(0.5 * n)); }

// Uniform variables of a direction in n dimensions: angles in two and three, else n normal variables, which
// are cheap to map.
int direction_uniforms(int n) { return n <= 3 ? n - 1 : n; }

// Uniform direction on the unit sphere in x.dimensions() coordinates from u[first...].
void unit_sphere(const PointBatch& u, int first, PointBuffer& x) {
    const int n = x.dimensions();
    for (std::size_t i = 0; i < x.count(); ++i) {
        if (n <= 3) {
            const double c = n == 3 ? 1 - 2 * u(i, first) : 0, sine = std::sqrt((1 - c) * (1 + c));
            const double phi = 2 * pi * u(i, first + n - 2);
            x(i, n - 2) = sine * std::cos(phi);
            x(i, n - 1) = sine * std::sin(phi);
            if (n == 3) x(i, 0) = c;
            continue;
        }
        // Normalised normal variables (Muller 1959).
        double square = 0;
        for (int d = 0; d < n; ++d) {
            x(i, d) = normal_quantile(u(i, first + d));
            square += x(i, d) * x(i, d);
        }
        // The middle of the cube, a grid point, has no direction: take any.
        if (square == 0) x(i, 0) = square = 1;
        const double scale = 1 / std::sqrt(square);
        for (int d = 0; d < n; ++d) x(i, d) *= scale;
    }
}

std::string describe(const std::vector<Range>& ranges) {
    std::ostringstream text;
    if (ranges.size() <= 4) {
        for (std::size_t d = 0; d < ranges.size(); ++d)
            text << (d ? " x " : "") << "[" << ranges[d].lower << ", " << ranges[d].upper << "]";
    } else {
        text << "box in " << ranges.size() << " dimensions";
    }
    return text.str();
}

} // namespace

Domain::Domain(std::shared_ptr<const Implementation> implementation)
    : implementation_(std::move(implementation)) {}

Domain::Domain(std::vector<Range> ranges) {
    check_dimensions("Domain", static_cast<int>(ranges.size()), 1);
    auto made = std::make_shared<Implementation>();
    double volume = 1;
    for (std::size_t d = 0; d < ranges.size(); ++d) {
        check(ranges[d], d);
        volume *= ranges[d].upper - ranges[d].lower;
    }
    // Infinite where a range is, and where the product of finite ones is too large for a number.
    const bool finite = std::all_of(ranges.begin(), ranges.end(),
                                    [](const Range& r) { return std::isfinite(r.upper - r.lower); });
    if (finite && !(std::isfinite(volume) && volume > 0))
        throw Error("Domain",
                    "the volume of the box is not a number above zero that fits in double precision");
    if (finite) made->constant_volume = volume;
    made->dimensions = made->uniforms = static_cast<int>(ranges.size());
    made->description = describe(ranges);
    made->ranges = ranges;
    const bool unit = finite && std::all_of(ranges.begin(), ranges.end(),
                                            [](const Range& r) { return r.lower == 0 && r.upper == 1; });
    made->unit_cube = unit;
    made->map = [ranges = std::move(ranges), unit](const PointBatch& u, PointBuffer& x, std::span<double> v) {
        for (int d = 0; d < x.dimensions(); ++d) {
            if (unit)
                std::copy_n(u.coordinate(d).data(), u.count(), x.coordinate(d).data());
            else
                map_range(ranges[static_cast<std::size_t>(d)], u.coordinate(d), x.coordinate(d), v);
        }
    };
    implementation_ = std::move(made);
}

Domain Domain::unit_cube(int dimensions) {
    check_dimensions("Domain::unit_cube", dimensions, 1);
    return Domain(std::vector<Range>(static_cast<std::size_t>(dimensions)));
}

// x_d = (1 - sum of the earlier ones) (1 - (1 - u_d)^(1 / (n - d))), each the quantile of its conditional
// density, so that the map is smooth and its factor is 1 / n! everywhere.
Domain Domain::simplex(int dimensions) {
    check_dimensions("Domain::simplex", dimensions, 1);
    auto made = std::make_shared<Implementation>();
    made->dimensions = made->uniforms = dimensions;
    made->description = "simplex in " + std::to_string(dimensions) + " dimensions";
    const double volume =
        checked_volume("Domain::simplex", dimensions, std::exp(-std::lgamma(dimensions + 1.0)));
    made->constant_volume = volume;
    made->map = [volume](const PointBatch& u, PointBuffer& x, std::span<double> v) {
        const int n = x.dimensions();
        for (std::size_t i = 0; i < x.count(); ++i) {
            double rest = 1;
            for (int d = 0; d < n; ++d) {
                const double kept = std::pow(1 - u(i, d), 1.0 / (n - d));
                x(i, d) = rest * (1 - kept);
                rest *= kept;
            }
            v[i] *= volume;
        }
    };
    return Domain(std::move(made));
}

Domain Domain::ball(std::vector<double> centre, double radius) {
    check_sphere("Domain::ball", centre, radius, 1);
    const int n = static_cast<int>(centre.size());
    if (n == 1) return interval(centre[0] - radius, centre[0] + radius);
    auto made = std::make_shared<Implementation>();
    made->dimensions = n;
    made->uniforms = 1 + direction_uniforms(n);
    made->description = "ball in " + std::to_string(n) + " dimensions";
    const double volume = checked_volume("Domain::ball", n, sphere_area(n) / n * std::pow(radius, n));
    made->constant_volume = volume;
    made->map = [centre = std::move(centre), radius, volume](const PointBatch& u, PointBuffer& x,
                                                             std::span<double> v) {
        const int dimensions = x.dimensions();
        unit_sphere(u, 1, x);
        for (std::size_t i = 0; i < x.count(); ++i) {
            const double r = radius * std::pow(u(i, 0), 1.0 / dimensions);
            for (int d = 0; d < dimensions; ++d) x(i, d) = centre[static_cast<std::size_t>(d)] + r * x(i, d);
            v[i] *= volume;
        }
    };
    return Domain(std::move(made));
}

Domain Domain::sphere(std::vector<double> centre, double radius) {
    check_sphere("Domain::sphere", centre, radius, 2);
    const int n = static_cast<int>(centre.size());
    auto made = std::make_shared<Implementation>();
    made->dimensions = n;
    made->uniforms = direction_uniforms(n);
    made->description = "sphere in " + std::to_string(n) + " dimensions";
    const double area = checked_volume("Domain::sphere", n, sphere_area(n) * std::pow(radius, n - 1));
    made->constant_volume = area;
    made->map = [centre = std::move(centre), radius, area](const PointBatch& u, PointBuffer& x,
                                                           std::span<double> v) {
        unit_sphere(u, 0, x);
        for (int d = 0; d < x.dimensions(); ++d)
            for (double& c : x.coordinate(d)) c = centre[static_cast<std::size_t>(d)] + radius * c;
        for (double& w : v) w *= area;
    };
    return Domain(std::move(made));
}

Domain Domain::mapped_batch(int uniforms, int dimensions, BatchMap map, std::string description) {
    check_dimensions("Domain::mapped", uniforms, 1);
    check_dimensions("Domain::mapped", dimensions, 1);
    auto made = std::make_shared<Implementation>();
    made->dimensions = dimensions;
    made->uniforms = uniforms;
    made->description = std::move(description);
    made->map = std::move(map);
    return Domain(std::move(made));
}

Domain Domain::mapped(int uniforms, int dimensions, PointMap map, std::string description) {
    auto batch = [map = std::move(map)](const PointBatch& u, PointBuffer& x, std::span<double> v) {
        std::vector<double> from(static_cast<std::size_t>(u.dimensions())),
            to(static_cast<std::size_t>(x.dimensions()));
        for (std::size_t i = 0; i < x.count(); ++i) {
            u.gather(i, from.data());
            v[i] *= map(from, to);
            for (int d = 0; d < x.dimensions(); ++d) x(i, d) = to[static_cast<std::size_t>(d)];
        }
    };
    return mapped_batch(uniforms, dimensions, std::move(batch), std::move(description));
}

Domain Domain::product(const Domain& a, const Domain& b) {
    if (!a.ranges().empty() && !b.ranges().empty()) {
        std::vector<Range> ranges(a.ranges().begin(), a.ranges().end());
        ranges.insert(ranges.end(), b.ranges().begin(), b.ranges().end());
        return Domain(std::move(ranges));
    }
    auto made = std::make_shared<Implementation>();
    made->dimensions = a.dimensions() + b.dimensions();
    made->uniforms = a.uniforms() + b.uniforms();
    made->description = a.description() + " x " + b.description();
    if (a.constant_volume() != 0 && b.constant_volume() != 0)
        made->constant_volume =
            checked_volume("Domain::product", made->dimensions, a.constant_volume() * b.constant_volume());
    made->map = [a, b](const PointBatch& u, PointBuffer& x, std::span<double> v) {
        PointBuffer part;
        int to = 0, from = 0;
        for (const Domain* domain : {&a, &b}) {
            part.resize(u.count(), domain->dimensions());
            const PointBatch own(u.data() + static_cast<std::size_t>(from) * u.stride(), u.count(),
                                 domain->uniforms(), u.stride());
            domain->map(own, part, v);
            for (int d = 0; d < domain->dimensions(); ++d)
                std::copy_n(part.coordinate(d).data(), u.count(), x.coordinate(to++).data());
            from += domain->uniforms();
        }
    };
    return Domain(std::move(made));
}

Domain Domain::named(std::vector<std::string> names) const {
    if (names.size() != static_cast<std::size_t>(dimensions()))
        throw Error("Domain", std::to_string(names.size()) + " names are given for " +
                                  std::to_string(dimensions()) + " coordinates; expected one for each");
    auto made = std::make_shared<Implementation>(*implementation_);
    made->names = std::move(names);
    return Domain(std::move(made));
}

int Domain::dimensions() const { return implementation_->dimensions; }
int Domain::uniforms() const { return implementation_->uniforms; }
std::span<const Range> Domain::ranges() const { return implementation_->ranges; }
const std::string& Domain::description() const { return implementation_->description; }
std::string Domain::name(int d) const {
    if (!implementation_->names.empty()) return implementation_->names[static_cast<std::size_t>(d)];
    return dimensions() == 1 ? "x" : "x" + std::to_string(d + 1);
}
bool Domain::is_unit_cube() const { return implementation_->unit_cube; }
double Domain::constant_volume() const { return implementation_->constant_volume; }
void Domain::map(const PointBatch& u, PointBuffer& x, std::span<double> volume) const {
    implementation_->map(u, x, volume);
}
void Domain::inverse(const PointBatch& x, PointBuffer& u, std::span<double> volume) const {
    if (ranges().empty())
        throw Error("Domain", "points of a " + description() +
                                  " cannot be mapped back to the unit cube; expected a box of ranges");
    for (int d = 0; d < u.dimensions(); ++d)
        unmap_range(ranges()[static_cast<std::size_t>(d)], x.coordinate(d), u.coordinate(d), volume);
}

} // namespace montelux
