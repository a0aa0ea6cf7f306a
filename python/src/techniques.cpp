#include "python/src/bindings.h"
#include "python/src/numpy_bridge.h"
#include "python/src/python_function.h"
#include "python/src/recipe.h"
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/techniques/technique.h"

namespace montelux::python {
namespace {

Technique functions(int uniforms, int dimensions, nb::object sample, nb::object density) {
    PythonFunction draw(std::move(sample), "Technique, sample"), p(std::move(density), "Technique, density");
    return Technique::batch(
        uniforms, dimensions,
        [draw](const PointBatch& u, PointBuffer& x) {
            draw.fill(u, ValueBatch(x.coordinate(0).data(), x.count(), x.dimensions(), x.count()),
                      x.dimensions() > 1);
        },
        [p](const PointBatch& x, std::span<double> values) {
            p.fill(x, ValueBatch(values.data(), values.size(), 1, values.size()), false);
        });
}

// One distribution, or a sequence of them.
Technique of_distributions(const nb::object& given) {
    if (nb::isinstance<Distribution>(given)) return Technique(nb::cast<Distribution>(given));
    std::vector<Distribution> factors;
    if (!nb::try_cast(given, factors))
        throw nb::type_error(("Technique: an object of type '" +
                              std::string(nb::type_name(given.type()).c_str()) +
                              "' was given; expected a Distribution, or a list of them, one per coordinate")
                                 .c_str());
    return Technique(std::move(factors));
}

} // namespace

void bind_techniques(nb::module_& m) {
    nb::class_<Technique>(m, "Technique", nb::dynamic_attr(),
                          "Points that follow a density, for Importance and MultipleImportance.\n\n"
                          "A Distribution, or a list of them (one per coordinate), is a technique by itself.")
        .def(
            "__init__",
            [](nb::pointer_and_handle<Technique> self, const nb::object& distributions) {
                new (self.p) Technique(of_distributions(distributions));
                const bool one = nb::isinstance<Distribution>(distributions);
                note_recipe(self.h, nb::make_tuple(one ? distributions : nb::tuple(distributions)));
            },
            nb::sig("def __init__(self, distributions: Distribution | Sequence[Distribution], /) -> None"))
        .def_static(
            "functions", &functions, "uniforms"_a, "dimensions"_a, "sample"_a, "density"_a,
            "From functions: sample(u) carries uniform numbers of shape (n, uniforms) to points of "
            "shape (n, dimensions), and density(x) gives their densities, shape (n,). One number, or "
            "one coordinate, comes as shape (n,). The density must be that of the points, with integral one: "
            "this is not checked, and another integral divides the result.")
        .def_static("uniform", &Technique::uniform, "domain"_a, "Uniform over a box that is finite.")
        .def_prop_ro("uniforms", &Technique::uniforms, "Uniform numbers that a point takes.")
        .def_prop_ro("dimensions", &Technique::dimensions, "Coordinates of a point.");
    nb::implicitly_convertible<Distribution, Technique>();
    nb::implicitly_convertible<std::vector<Distribution>, Technique>();
}

} // namespace montelux::python
