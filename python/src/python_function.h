// A Python function as the library calls it: from any thread, with points and values that are not copied.
#pragma once

#include <memory>
#include <nanobind/nanobind.h>
#include <string>

#include "montelux/mc/integrate/integrand.h"
#include "montelux/mc/integrate/points.h"

namespace montelux::python {

namespace nb = nanobind;

// Copies share one reference, which is given back under the interpreter's lock, whatever thread drops it.
class PythonFunction {
  public:
    // `what` begins the sentences of errors ("integrand"). To be called with the lock held.
    PythonFunction(nb::object function, std::string what);

    // y = f(x) for points and values of the library; `as_vector`: f returns shape (n, m), else (n,). With
    // `into`, f(x, y) writes to an array on the values themselves.
    void fill(const PointBatch& x, const ValueBatch& y, bool as_vector, bool into = false) const;
    // A number for a number.
    double operator()(double x) const;
    // What it returns for points, under the lock that the caller holds.
    nb::object call(const PointBatch& x) const;

    const nb::handle function() const { return function_.get(); }
    const std::string& what() const { return *what_; }

  private:
    std::shared_ptr<PyObject> function_;
    std::shared_ptr<const std::string> what_;
};

// f in the form that the library integrates. `components` 0: one value a point, as shape (n,).
Integrand integrand_of(const PythonFunction& f, int components, bool into);

} // namespace montelux::python
