// PythonFunction: a Python function called by the library, from any thread, without copying points or values.
#pragma once

#include <memory>
#include <nanobind/nanobind.h>
#include <string>

#include "montelux/mc/integrate/integrand.h"
#include "montelux/mc/integrate/points.h"

namespace montelux::python {

namespace nb = nanobind;

// Copies share one reference, which is released under the interpreter's lock, whatever thread drops it.
class PythonFunction {
  public:
    // `what` begins error messages ("integrand"). Requires the lock.
    PythonFunction(nb::object function, std::string what);

    // y = f(x) for points and values of the library; `as_vector`: f returns shape (n, m), else (n,). With
    // `into`, f(x, y) writes into an array on the values themselves.
    void fill(const PointBatch& x, const ValueBatch& y, bool as_vector, bool into = false) const;
    // For a function of one number.
    double operator()(double x) const;
    // The return value for some points; the caller holds the lock.
    nb::object call(const PointBatch& x) const;

    const nb::handle function() const { return function_.get(); }
    const std::string& what() const { return *what_; }

  private:
    std::shared_ptr<PyObject> function_;
    std::shared_ptr<const std::string> what_;
};

// f in the library's form. `components` 0: one value per point, as shape (n,).
Integrand integrand_of(const PythonFunction& f, int components, bool into);

} // namespace montelux::python
