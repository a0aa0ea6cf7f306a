#include "python/src/bindings.h"
#include "python/src/names.h"
#include "python/src/numpy_bridge.h"
#include <vector>

#include "montelux/mc/random/discrepancy.h"
#include "montelux/mc/random/point_set.h"

namespace montelux::python {
namespace {

DoubleArray points(const std::string& kind, std::uint32_t count, int dimensions,
                   const std::string& randomised, std::uint64_t seed) {
    PointSet::Settings settings;
    settings.kind = point_sets.value(kind);
    settings.count = count;
    settings.dimensions = dimensions;
    settings.randomisation = randomisations.value(randomised);
    settings.seed = seed;
    const PointSet set(settings);
    const std::size_t shape[] = {count, static_cast<std::size_t>(dimensions)};
    NewArray out = new_array(shape);
    {
        nb::gil_scoped_release unlocked;
        double* at = out.data;
        for (std::uint32_t i = 0; i < count; ++i)
            for (int d = 0; d < dimensions; ++d) *at++ = set(i, d);
    }
    return out.array;
}

// (n,) or (n, 1): one dimension; (n, d).
std::size_t dimensions_of(const Numbers& n, const char* what) {
    if (n.shape.size() == 1) return 1;
    if (n.shape.size() != 2 || n.shape[1] == 0)
        throw Error(what, "expected an array of shape (n, d) or (n,)");
    return n.shape[1];
}

double star(const nb::object& given) {
    const Numbers n = numbers_of(given, "star_discrepancy");
    const std::size_t d = dimensions_of(n, "star_discrepancy");
    if (d > 2)
        throw Error("star_discrepancy", "points of " + std::to_string(d) +
                                            " dimensions were given; it is known in one and two "
                                            "(l2_star_discrepancy in any number)");
    for (double x : n.values)
        if (!(x >= 0 && x <= 1)) throw Error("star_discrepancy", "a point lies outside the unit square");
    std::vector<Vec2d> pairs;
    for (std::size_t i = 0; d == 2 && i < n.values.size(); i += 2)
        pairs.push_back({n.values[i], n.values[i + 1]});
    nb::gil_scoped_release unlocked;
    return d == 1 ? star_discrepancy(n.values) : star_discrepancy(std::span<const Vec2d>(pairs));
}

double l2_star(const nb::object& given) {
    const Numbers n = numbers_of(given, "l2_star_discrepancy");
    const auto d = static_cast<int>(dimensions_of(n, "l2_star_discrepancy"));
    nb::gil_scoped_release unlocked;
    return l2_star_discrepancy(n.values, d);
}

} // namespace

void bind_points(nb::module_& m) {
    m.def("points", &points, "kind"_a, "count"_a, "dimensions"_a = 2, "randomisation"_a = "none",
          "seed"_a = 0,
          "Points of a set in [0, 1)^dimensions, shape (count, dimensions).\n\n"
          "kind: 'independent', 'halton', 'hammersley', 'sobol', 'golden_ratio' or 'weyl'. randomisation: "
          "'none', "
          "'shift', 'digit_permutation' (Halton, Hammersley) or 'scramble' (these and Sobol'); over seeds "
          "every "
          "randomised point is uniform.");
    m.def(
        "nearest_name",
        [](const std::string& name, const std::vector<std::string>& known) {
            return std::string(nearest_name(name, std::vector<std::string_view>(known.begin(), known.end())));
        },
        "name"_a, "known"_a, "The known name that is nearest to a misspelt one; empty when none is near.");
    m.def(
        "star_discrepancy", &star, "points"_a.none(),
        "Largest difference between the share of points in a box [0, a) and its volume; exact, for points of "
        "shape (n,) or (n, 2) in the unit square.");
    m.def(
        "l2_star_discrepancy", &l2_star, "points"_a.none(),
        "Root of the mean squared difference over boxes [0, a), for points of shape (n, d) (Warnock 1972).");
}

} // namespace montelux::python
