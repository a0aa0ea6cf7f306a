// The parts of the extension module montelux._core: one file per topic.
#pragma once

#include <nanobind/nanobind.h>
// Every file includes all type casters: a missing one shows only when the module is loaded, not when it is
// compiled.
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

namespace montelux::python {

namespace nb = nanobind;
using namespace nb::literals; // NOLINT(google-build-using-namespace): "name"_a in every binding

// montelux.Error, the translation of every montelux::Error.
void bind_error(nb::module_& m);
void bind_domains(nb::module_& m);
void bind_distributions(nb::module_& m);
void bind_techniques(nb::module_& m);
void bind_methods(nb::module_& m);
void bind_c_functions(nb::module_& m);
void bind_devices(nb::module_& m);
void bind_trained(nb::module_& m); // trained densities and their samples
void bind_integrate(nb::module_& m);
void bind_metropolis(nb::module_& m);
void bind_chains(nb::module_& m); // montelux.sample
void bind_points(nb::module_& m);
void bind_warps(nb::module_& m);
void bind_tables(nb::module_& m); // discrete variables, tabulated densities
void bind_spectra(nb::module_& m);
void bind_images(nb::module_& m);
void bind_environments(nb::module_& m); // sampling of maps
void bind_bake(nb::module_& m);
void bind_materials(nb::module_& m);
void bind_lights(nb::module_& m);
void bind_shapes(nb::module_& m);
void bind_filters(nb::module_& m);
void bind_film(nb::module_& m);
void bind_views(nb::module_& m); // camera, sampler, integrator
void bind_textures(nb::module_& m);
void bind_scene_lists(nb::module_& m);
void bind_scene(nb::module_& m);
void bind_guide(nb::module_& m);
void bind_render(nb::module_& m);
void bind_paths(nb::module_& m); // strategies of a bidirectional picture, chains of a Metropolis picture
void bind_compare(nb::module_& m);
void bind_testing(nb::module_& m);

} // namespace montelux::python
