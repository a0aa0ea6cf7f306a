#include "python/src/recipe.h"
#include "python/src/warp.h"
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "montelux/mc/dist/alias_table.h"
#include "montelux/mc/dist/discrete.h"
#include "montelux/mc/dist/piecewise_2d.h"
#include "montelux/mc/math/error.h"

namespace montelux::python {
namespace {

Numbers weights_of(const nb::object& given, const char* what) {
    Numbers n = numbers_of(given, what);
    if (n.shape.size() != 1) throw Error(what, "expected an array of shape (n,)");
    return n;
}

// Indices by `draw` for uniform numbers of any shape; one per number.
template <typename Draw>
nb::object indices(const nb::object& given, const char* what, const Draw& draw) {
    const Numbers u = numbers_of(given, what);
    require_uniform(u.values, what);
    if (u.shape.empty()) return nb::int_(draw(u.values[0]));
    NewIndexArray out = new_index_array(u.shape);
    {
        nb::gil_scoped_release unlocked;
        for (std::size_t i = 0; i < u.values.size(); ++i) out.data[i] = draw(u.values[i]);
    }
    return out.array;
}

// of(0), of(1), ... of each index.
template <typename Of>
DoubleArray of_indices(std::size_t count, const Of& of) {
    const std::size_t shape[] = {count};
    NewArray out = new_array(shape);
    for (std::size_t i = 0; i < count; ++i) out.data[i] = static_cast<double>(of(i));
    return out.array;
}

constexpr const char* sample_signature = "def sample(self, u: object) -> object";

void bind_discrete(nb::module_& m) {
    nb::class_<DiscreteDistribution>(
        m, "Discrete", nb::dynamic_attr(),
        "A variable with the values 0, 1, ... n - 1, drawn by inversion of its cumulative sum.\n\n"
        "Discrete(weights): probabilities in proportion to weights of shape (n,), which are not negative; "
        "all "
        "zero: uniform.")
        .def(
            "__init__",
            [](nb::pointer_and_handle<DiscreteDistribution> self, const nb::object& weights) {
                const Numbers given = weights_of(weights, "Discrete");
                new (self.p) DiscreteDistribution(given.values);
                note_recipe(self.h, nb::make_tuple(new_array(given.values)));
            },
            "weights"_a)
        .def(
            "sample",
            [](const DiscreteDistribution& d, const nb::object& u) {
                return indices(u, "Discrete.sample", [&](double v) { return d.sample(v).index; });
            },
            "u"_a, nb::sig(sample_signature),
            "Indices (int64) for uniform numbers u in [0, 1] of any shape, by bisection, O(log n).")
        .def(
            "sample_by_walking",
            [](const DiscreteDistribution& d, const nb::object& u) {
                return indices(u, "Discrete.sample_by_walking",
                               [&](double v) { return d.sample_by_walking(v).index; });
            },
            "u"_a, nb::sig("def sample_by_walking(self, u: object) -> object"),
            "The same indices, by walking the sum from its start, O(n).")
        .def_prop_ro(
            "probabilities",
            [](const DiscreteDistribution& d) {
                return of_indices(d.size(), [&](std::size_t i) { return d.probability(i); });
            },
            "Of each index, shape (n,).")
        .def_prop_ro(
            "cdf",
            [](const DiscreteDistribution& d) {
                return of_indices(d.size(), [&](std::size_t i) { return d.cdf(i); });
            },
            "Probability of all indices up to and including each, shape (n,); the last is one.")
        .def_prop_ro("weight_sum", &DiscreteDistribution::weight_sum, "The sum of the weights.")
        .def("__len__", &DiscreteDistribution::size)
        .def("__repr__", [](const DiscreteDistribution& d) {
            return nb::str(("<montelux.Discrete of " + std::to_string(d.size()) + " values>").c_str());
        });
    nb::class_<AliasTable>(
        m, "AliasTable", nb::dynamic_attr(),
        "A variable with the values 0, 1, ... n - 1, drawn in constant time (Walker 1974, Vose 1991).\n\n"
        "AliasTable(weights): as Discrete. Probabilities are kept in single precision.")
        .def(
            "__init__",
            [](nb::pointer_and_handle<AliasTable> self, const nb::object& weights) {
                const Numbers given = weights_of(weights, "AliasTable");
                new (self.p) AliasTable(given.values);
                note_recipe(self.h, nb::make_tuple(new_array(given.values)));
            },
            "weights"_a)
        .def(
            "sample",
            [](const AliasTable& t, const nb::object& u) {
                return indices(u, "AliasTable.sample", [&](double v) { return t.sample(v).index; });
            },
            "u"_a, nb::sig(sample_signature),
            "Indices (int64) for uniform numbers u in [0, 1] of any shape, O(1). They do not grow with u.")
        .def_prop_ro(
            "probabilities",
            [](const AliasTable& t) {
                return of_indices(t.size(), [&](std::size_t i) { return t.probability(i); });
            },
            "Of each index, shape (n,).")
        .def_prop_ro("weight_sum", &AliasTable::weight_sum, "The sum of the weights.")
        .def("__len__", &AliasTable::size)
        .def("__repr__", [](const AliasTable& t) {
            return nb::str(("<montelux.AliasTable of " + std::to_string(t.size()) + " values>").c_str());
        });
}

Warp tabulated_warp(const nb::object& values, std::array<double, 2> lower, std::array<double, 2> upper) {
    const Numbers n = numbers_of(values, "warp tabulated");
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (n.shape.size() != 2 || n.values.empty() || n.values.size() > most)
        throw Error("warp tabulated", "expected an array of shape (rows, columns)");
    // Shared, for the functions of a warp are copied.
    const auto table = std::make_shared<const PiecewiseConstant2D>(
        n.values, static_cast<std::uint32_t>(n.shape[1]), static_cast<std::uint32_t>(n.shape[0]),
        two(lower.data()), two(upper.data()));
    return of_plane(
        "tabulated", [table](Vec2d u) { return table->sample(u).p; },
        [table](Vec2d p) { return table->pdf(p); },
        [table](Vec2d p) {
            constexpr double none = std::numeric_limits<double>::quiet_NaN();
            return table->inverse(p).value_or(Vec2d{none, none});
        });
}

} // namespace

void bind_tables(nb::module_& m) {
    bind_discrete(m);
    m.def("warp_tabulated", &tabulated_warp, "values"_a, "lower"_a = std::array<double, 2>{0, 0},
          "upper"_a = std::array<double, 2>{1, 1},
          "Density on a rectangle that is constant on each of its cells, in proportion to `values` of shape "
          "(rows, columns).\n\n"
          "Columns go along x, rows along y from `lower` on; the second uniform number picks the row, the "
          "first "
          "the column. inverse() is NaN where the density is zero.");
}

} // namespace montelux::python
