// CompiledFunction: a DeviceFunction as Python holds it.
#pragma once

#include <memory>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/integrate/integrand.h"

namespace montelux::python {

struct CompiledFunction {
    std::shared_ptr<const DeviceFunction> function;

    // Ctrl-C ends it between blocks of points. Called on the thread that looks for signals.
    Integrand integrand() const;
};

} // namespace montelux::python
