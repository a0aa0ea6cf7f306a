// NumPy arrays on the library's memory, and numbers from return values of Python functions.
#pragma once

#include <cstdint>
#include <nanobind/nanobind.h>
#include <span>
#include <string_view>
#include <vector>

#include "montelux/mc/integrate/points.h"

namespace montelux::python {

namespace nb = nanobind;

bool is_array(PyObject* o);

// An array of doubles, by its type in the stubs.
class DoubleArray : public nb::object {
    NB_OBJECT_DEFAULT(DoubleArray, nb::object, "numpy.typing.NDArray[numpy.float64]", is_array)
};

// An array of int64.
class IndexArray : public nb::object {
    NB_OBJECT_DEFAULT(IndexArray, nb::object, "numpy.typing.NDArray[numpy.int64]", is_array)
};

// Loads NumPy's table of functions; before anything else here.
void import_numpy();

// An array on the points themselves without a copy: shape (n, d), or (n,) for one coordinate; read-only. The
// memory belongs to the library and limits the array's lifetime.
nb::object view_of(const PointBatch& points);
// The same for writable values: shape (n, m), or (n,) if there is one and `as_vector` is false.
nb::object view_of(const ValueBatch& values, bool as_vector);

// The number of outside references to an array of view_of, including its views.
bool is_kept_elsewhere(const nb::object& array);

// Fills `values` from a function's return value: shape (n,) for one value per point (or (n, m) with m = 1 and
// `as_vector`), else (n, m). Throws Error beginning with `what` for other shapes and for anything but real
// numbers.
void copy_values(const nb::object& returned, const ValueBatch& values, bool as_vector, std::string_view what);
// The number of values per point in a return value for n points: 0 for shape (n,), m for (n, m).
int values_a_point(const nb::object& returned, std::size_t n, std::string_view what);

// New arrays that own their memory.
DoubleArray new_array(std::span<const double> values);
DoubleArray new_array(std::span<const double> values, std::size_t rows, std::size_t columns);
// A new uninitialised array of doubles, and the address of its data (row by row).
struct NewArray {
    DoubleArray array;
    double* data;
};
NewArray new_array(std::span<const std::size_t> shape);
struct NewIndexArray {
    IndexArray array;
    std::int64_t* data;
};
NewIndexArray new_index_array(std::span<const std::size_t> shape);

// A read-only array of float32 on the memory of a picture of interleaved channels, kept alive by `owner`:
// shape (height, width, count), or (height, width) for one.
nb::object float_view(const float* data, std::size_t height, std::size_t width, std::size_t channels,
                      std::size_t count, const nb::object& owner);

// The argument as a C-contiguous array of doubles (converted if necessary), flattened. Throws Error beginning
// with `what` for anything but real numbers.
struct Numbers {
    nb::object array;
    std::span<const double> values;
    std::vector<std::size_t> shape;
};
Numbers numbers_of(const nb::handle& given, std::string_view what);

// Rows of `size` numbers: an array of shape (..., size). Throws Error beginning with `what` for other shapes.
struct Rows {
    Numbers numbers;
    std::size_t size;

    Rows(const nb::handle& given, std::size_t size, std::string_view what);
    std::size_t count() const { return numbers.values.size() / size; }
    const double* operator[](std::size_t i) const { return numbers.values.data() + size * i; }
    // Shape of an array with one number for each row, and with n of them.
    std::vector<std::size_t> shape() const;
    std::vector<std::size_t> shape(std::size_t n) const;
};

// Throws Error beginning with `what` for a number outside [0, 1].
void require_uniform(std::span<const double> u, std::string_view what);

} // namespace montelux::python
