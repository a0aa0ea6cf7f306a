#include "python/src/python_function.h"

#include "python/src/interruptible.h"
#include "python/src/numpy_bridge.h"
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux::python {
namespace {

// The frames of a failed function may keep arrays on memory that is about to be reused, and debuggers inspect
// them: their local variables are cleared.
[[noreturn]] void rethrow_without(const nb::object& x) {
    nb::python_error error;
    if (is_kept_elsewhere(x) && error.traceback().is_valid())
        nb::module_::import_("traceback").attr("clear_frames")(error.traceback());
    error.restore();
    throw_python_error();
}

nb::object called(nb::handle f, PyObject** arguments, std::size_t count, const nb::object& x) {
    PyObject* result =
        PyObject_Vectorcall(f.ptr(), arguments, count | PY_VECTORCALL_ARGUMENTS_OFFSET, nullptr);
    if (!result) rethrow_without(x);
    nb::object returned = nb::steal(result);
    // A function written in C never checks for signals.
    if (PyErr_CheckSignals() != 0) rethrow_without(x);
    return returned;
}

void refuse_kept(const nb::object& x, const std::string& what) {
    if (is_kept_elsewhere(x))
        throw Error(what,
                    "the array of points was kept beyond the call, and its memory is used again; keep a "
                    "copy: x.copy()");
}

} // namespace

PythonFunction::PythonFunction(nb::object function, std::string what)
    : function_(function.release().ptr(),
                [](PyObject* f) {
                    if (!Py_IsInitialized()) return; // the process ends
                    nb::gil_scoped_acquire lock;
                    Py_DECREF(f);
                }),
      what_(std::make_shared<const std::string>(std::move(what))) {
    if (!PyCallable_Check(function_.get()))
        throw Error(this->what(), "an object of type '" +
                                      std::string(nb::type_name(nb::handle(function_.get()).type()).c_str()) +
                                      "' was given; expected a function");
}

nb::object PythonFunction::call(const PointBatch& x) const {
    nb::object points = view_of(x);
    PyObject* arguments[] = {nullptr, points.ptr()};
    nb::object returned = called(function_.get(), arguments + 1, 1, points);
    return returned;
}

void PythonFunction::fill(const PointBatch& x, const ValueBatch& y, bool as_vector, bool into) const {
    nb::gil_scoped_acquire lock;
    nb::object points = view_of(x);
    if (into) {
        nb::object values = view_of(y, as_vector);
        PyObject* arguments[] = {nullptr, points.ptr(), values.ptr()};
        called(function_.get(), arguments + 1, 2, points);
        refuse_kept(values, what());
    } else {
        PyObject* arguments[] = {nullptr, points.ptr()};
        copy_values(called(function_.get(), arguments + 1, 1, points), y, as_vector, what());
    }
    refuse_kept(points, what());
}

double PythonFunction::operator()(double x) const {
    nb::gil_scoped_acquire lock;
    nb::object argument = nb::steal(PyFloat_FromDouble(x));
    PyObject* arguments[] = {nullptr, argument.ptr()};
    PyObject* result =
        PyObject_Vectorcall(function_.get(), arguments + 1, 1 | PY_VECTORCALL_ARGUMENTS_OFFSET, nullptr);
    if (!result) throw_python_error();
    nb::object returned = nb::steal(result);
    const double value = PyFloat_AsDouble(returned.ptr());
    if (value == -1 && PyErr_Occurred()) {
        PyErr_Clear();
        throw Error(what(), "an object of type '" + std::string(nb::type_name(returned.type()).c_str()) +
                                "' was returned for a number; expected a real number");
    }
    return value;
}

Integrand integrand_of(const PythonFunction& f, int components, bool into) {
    const bool as_vector = components > 0;
    return Integrand::batch(
        [f, as_vector, into](const PointBatch& x, ValueBatch y) { f.fill(x, y, as_vector, into); },
        as_vector ? components : 1);
}

} // namespace montelux::python
