#include "python/src/bindings.h"
#include "python/src/numpy_bridge.h"
#include "python/src/python_function.h"
#include <utility>
#include <vector>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/math/error.h"

namespace montelux::python {
namespace {

Domain box(const std::vector<std::pair<double, double>>& ranges) {
    std::vector<Range> all;
    for (const auto& [lower, upper] : ranges) all.push_back({lower, upper});
    return Domain(std::move(all));
}

// The centre of a ball or sphere: its coordinates, or a number of dimensions for the origin.
std::vector<double> centre_of(const nb::object& centre, const std::string& what) {
    if (int dimensions = 0; nb::try_cast(centre, dimensions)) {
        if (dimensions < 1)
            throw Error(what, std::to_string(dimensions) + " dimensions were given; expected at least one");
        return std::vector<double>(static_cast<std::size_t>(dimensions));
    }
    std::vector<double> coordinates;
    if (nb::try_cast(centre, coordinates)) return coordinates;
    throw Error(what,
                "an object of type '" + std::string(nb::type_name(centre.type()).c_str()) +
                    "' was given; expected the coordinates of the centre, for example (0, 0, 1), or a number "
                    "of dimensions, for the origin");
}

// x, volume = map(u).
Domain mapped(int uniforms, int dimensions, nb::object map, const std::string& description) {
    PythonFunction f(std::move(map), "Domain.mapped");
    return Domain::mapped_batch(
        uniforms, dimensions,
        [f](const PointBatch& u, PointBuffer& x, std::span<double> volume) {
            nb::gil_scoped_acquire lock;
            const nb::object both = f.call(u);
            if (!nb::isinstance<nb::tuple>(both) || nb::len(both) != 2)
                throw Error(f.what(), "the map returned an object of type '" +
                                          std::string(nb::type_name(both.type()).c_str()) +
                                          "'; expected two arrays: points, and changes of volume");
            copy_values(both[0], ValueBatch(x.coordinate(0).data(), x.count(), x.dimensions(), x.count()),
                        x.dimensions() > 1, "Domain.mapped, points");
            std::vector<double> factor(volume.size());
            copy_values(both[1], ValueBatch(factor.data(), factor.size(), 1, factor.size()), false,
                        "Domain.mapped, changes of volume");
            for (std::size_t i = 0; i < volume.size(); ++i) volume[i] *= factor[i];
        },
        description);
}

nb::tuple map_points(const Domain& domain, const nb::object& u) {
    const Numbers given = numbers_of(u, "Domain.map");
    const auto k = static_cast<std::size_t>(domain.uniforms());
    if (!(given.shape.size() == 2 && given.shape[1] == k) && !(given.shape.size() == 1 && k == 1))
        throw Error("Domain.map", "expected an array of shape (n, " + std::to_string(k) + ")");
    const std::size_t n = given.shape[0];
    PointBuffer from(n, static_cast<int>(k)), to(n, domain.dimensions());
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t d = 0; d < k; ++d) from(i, static_cast<int>(d)) = given.values[i * k + d];
    std::vector<double> volume(n, 1.0), rows;
    domain.map(from, to, volume);
    for (std::size_t i = 0; i < n; ++i)
        for (int d = 0; d < to.dimensions(); ++d) rows.push_back(to(i, d));
    return nb::make_tuple(domain.dimensions() == 1
                              ? new_array(rows)
                              : new_array(rows, n, static_cast<std::size_t>(to.dimensions())),
                          new_array(volume));
}

} // namespace

void bind_domains(nb::module_& m) {
    nb::class_<Domain>(m, "Domain", nb::dynamic_attr(),
                       "A region of integration, as a map from the unit cube onto it.\n\n"
                       "Where a Domain is expected, a sequence of ranges (lower, upper), one per variable, "
                       "means a box.")
        .def_static("box", &box, "ranges"_a,
                    "The box of these ranges (lower, upper), one per variable; ends may be infinite.")
        .def_static("unit_cube", &Domain::unit_cube, "dimensions"_a, "[0, 1]^dimensions.")
        .def_static("simplex", &Domain::simplex, "dimensions"_a,
                    "x_j >= 0 with sum <= 1; its volume is 1 / dimensions!.")
        .def_static(
            "ball",
            [](const nb::object& centre, double radius) {
                return Domain::ball(centre_of(centre, "Domain.ball"), radius);
            },
            "centre"_a, "radius"_a = 1.0,
            "|x - centre| <= radius; the measure is volume. The centre is a sequence of coordinates, or a "
            "number "
            "of dimensions, for the origin: ball(3) is the unit ball in three dimensions.")
        .def_static(
            "sphere",
            [](const nb::object& centre, double radius) {
                return Domain::sphere(centre_of(centre, "Domain.sphere"), radius);
            },
            "centre"_a, "radius"_a = 1.0,
            "|x - centre| = radius; the measure is the surface's area. The centre as for ball().")
        .def_static("product", &Domain::product, "a"_a, "b"_a,
                    "Points whose coordinates are those of a, then those of b.")
        .def_static(
            "mapped", &mapped, "uniforms"_a, "dimensions"_a, "map"_a, "description"_a = "mapped",
            "Your own map of the unit cube: map(u), u of shape (n, uniforms), returns the points x of "
            "shape (n, dimensions) and the factors |dx/du| of shape (n,). Where there is one uniform "
            "number or one coordinate, shape (n,) takes the place of (n, 1).")
        .def_prop_ro("dimensions", &Domain::dimensions, "Coordinates of a point.")
        .def_prop_ro("uniforms", &Domain::uniforms, "Uniform variables that the map takes.")
        .def("map", &map_points, "u"_a.none(),
             "Points x of shape (n, dimensions) and factors |dx/du| of shape (n,) for points u of the unit "
             "cube, shape (n, uniforms).")
        .def("__repr__", [](const Domain& d) { return "<montelux.Domain " + d.description() + ">"; });
}

} // namespace montelux::python
