#include "python/src/bindings.h"
#include "python/src/numpy_bridge.h"
#include <nanobind/nanobind.h>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux::python {

void bind_error(nb::module_& m) {
    static PyObject* error = PyErr_NewExceptionWithDoc(
        "montelux.Error",
        "What the library cannot do, as a sentence: where, what was found, what was expected.",
        PyExc_RuntimeError, nullptr);
    m.attr("Error") = nb::borrow(error);
    nb::register_exception_translator(
        [](const std::exception_ptr& thrown, void* type) {
            try {
                std::rethrow_exception(thrown);
            } catch (const Error& e) {
                PyErr_SetString(static_cast<PyObject*>(type), e.what());
            }
        },
        error);
}

} // namespace montelux::python

NB_MODULE(_core, m) {
    using namespace montelux::python; // NOLINT(google-build-using-namespace): the bindings of this module
    m.doc() = "The compiled part of montelux; use the names of that package.";
    m.attr("version") = MONTELUX_VERSION;
    // Functions owned by distributions and methods live until the interpreter has ended.
    nb::set_leak_warnings(false);
    import_numpy();
    bind_error(m);
    bind_domains(m);
    bind_distributions(m);
    bind_techniques(m);
    bind_trained(m);
    bind_methods(m);
    bind_c_functions(m);
    bind_devices(m);
    bind_integrate(m);
    bind_metropolis(m);
    bind_chains(m);
    bind_points(m);
    bind_warps(m);
    bind_tables(m);
    bind_spectra(m);
    bind_images(m);
    bind_environments(m);
    bind_bake(m);
    bind_materials(m);
    bind_lights(m);
    bind_shapes(m);
    bind_filters(m);
    bind_film(m);
    bind_views(m);
    bind_textures(m);
    bind_scene_lists(m);
    bind_scene(m);
    bind_guide(m);
    bind_render(m);
    bind_paths(m);
    bind_compare(m);
    bind_testing(m);
}
