#include "python/src/bindings.h"
#include "python/src/numpy_bridge.h"
#include "python/src/python_function.h"
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

} // namespace

void bind_techniques(nb::module_& m) {
    nb::class_<Technique>(m, "Technique",
                          "Points that follow a density, for Importance and MultipleImportance.\n\n"
                          "A Distribution, or a list of them (one per coordinate), is a technique by itself.")
        .def(nb::init_implicit<Distribution>())
        .def(nb::init_implicit<std::vector<Distribution>>())
        .def_static(
            "functions", &functions, "uniforms"_a, "dimensions"_a, "sample"_a, "density"_a,
            "From functions: sample(u) carries uniform numbers of shape (n, uniforms) to points of "
            "shape (n, dimensions), and density(x) gives their densities, shape (n,). One number, or "
            "one coordinate, comes as shape (n,). The density must be that of the points, with integral one: "
            "this is not checked, and another integral divides the result.")
        .def_static("uniform", &Technique::uniform, "domain"_a, "Uniform over a box that is finite.")
        .def_prop_ro("uniforms", &Technique::uniforms, "Uniform numbers that a point takes.")
        .def_prop_ro("dimensions", &Technique::dimensions, "Coordinates of a point.");
}

} // namespace montelux::python
