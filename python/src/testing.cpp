#include "python/src/bindings.h"
#include "python/src/c_function.h"
#include <chrono>
#include <cstdint>
#include <nanobind/nanobind.h>

#include "montelux/mc/integrate/integrand.h"

namespace montelux::python {
namespace {

// (seconds per call, address of the points, address of the values).
nb::tuple call_integrand(const nb::object& f, std::size_t points, int dimensions, int calls, bool into) {
    const Integrand g = integrand_of(f, 0, into);
    PointBuffer x(points, dimensions);
    ValueBuffer y(points, 1);
    for (int d = 0; d < dimensions; ++d)
        for (double& v : x.coordinate(d)) v = 0.5;
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin, end;
    {
        nb::gil_scoped_release unlocked; // as in integrate()
        g(x, y);
        begin = Clock::now();
        for (int i = 0; i < calls; ++i) g(x, y);
        end = Clock::now();
    }
    return nb::make_tuple(std::chrono::duration<double>(end - begin).count() / calls,
                          reinterpret_cast<std::uintptr_t>(x.view().data()),
                          reinterpret_cast<std::uintptr_t>(y.component(0).data()));
}

} // namespace

void bind_testing(nb::module_& m) {
    m.def(
        "call_integrand", &call_integrand, "f"_a, "points"_a, "dimensions"_a, "calls"_a, "into"_a = false,
        "Calls f as the integrator does, with points of a buffer of its own: (seconds a call, address of the "
        "points, address of the values).");
}

} // namespace montelux::python
