#include "python/src/devices.h"

#include "python/src/bindings.h"
#include "python/src/interruptible.h"
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/device/formula_source.h"

namespace montelux::python {
namespace {

CompiledFunction compile(const std::string& device, const FunctionSource& source, int dimensions) {
    nb::gil_scoped_release unlocked; // compilers take a second
    return {std::make_shared<const DeviceFunction>(Device::open(device), source, dimensions)};
}

} // namespace

Integrand CompiledFunction::integrand() const {
    const Integrand f = Integrand::compiled(function);
    OnDevice device = f.on_device();
    device.before.emplace_back([](std::size_t) {
        nb::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw_python_error();
    });
    return f.with_device(std::move(device));
}

void bind_devices(nb::module_& m) {
    nb::class_<CompiledFunction>(m, "DeviceFunction", "An integrand that a device has compiled.")
        .def_static(
            "of_formulas",
            [](const std::string& device, const std::vector<std::string>& formulas,
               const std::vector<std::string>& variables,
               int dimensions) { return compile(device, formula_source(formulas, variables), dimensions); },
            "device"_a, "formulas"_a, "variables"_a, "dimensions"_a)
        .def_static(
            "of_source",
            [](const std::string& device, const std::string& text, int components, int dimensions) {
                return compile(device, {.text = text, .file = "integrand", .components = components},
                               dimensions);
            },
            "device"_a, "text"_a, "components"_a, "dimensions"_a)
        .def_prop_ro("device", [](const CompiledFunction& f) { return f.function->device()->description(); });
}

} // namespace montelux::python
