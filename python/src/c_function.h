// CFunction: an integrand compiled to machine code, called from any thread without the interpreter's lock.
#pragma once

#include <cstdint>
#include <nanobind/nanobind.h>
#include <string_view>
#include <variant>

#include "montelux/mc/integrate/integrand.h"

namespace montelux::python {

namespace nb = nanobind;

class CFunction {
  public:
    // The function at an address. `signature` is written in C: "double (int, double *)". `owner` keeps the
    // code alive. Throws Error for signatures that are not among those below.
    CFunction(std::uintptr_t address, std::string_view signature, void* user_data, nb::object owner);
    // Of a PyCapsule whose name is the signature and whose context is the user data, as in
    // scipy.LowLevelCallable.
    static CFunction of_capsule(const nb::object& capsule, nb::object owner);

    // In the library's form, while this object lives. `components` 0: one value per point.
    Integrand integrand(int components) const;

  private:
    using OfNumber = double (*)(double);
    using OfNumberWithData = double (*)(double, void*);
    using OfPoint = double (*)(int dimensions, double* x);
    using OfPointWithData = double (*)(int dimensions, double* x, void*);
    // x[d * points + i] is coordinate d of point i, y[c * points + i] its component c.
    using OfPoints = void (*)(int points, int dimensions, double* x, double* y);
    using Function = std::variant<OfNumber, OfNumberWithData, OfPoint, OfPointWithData, OfPoints>;

    static Function function_of(std::uintptr_t address, std::string_view signature, bool has_data);

    Function function_;
    void* user_data_;
    nb::object owner_;
};

// An integrand from a CFunction or a Python function, as montelux._core gets them. Requires the lock.
Integrand integrand_of(const nb::object& f, int components, bool into);

} // namespace montelux::python
