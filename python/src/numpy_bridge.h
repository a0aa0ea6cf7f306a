// NumPy arrays on memory of the library, and numbers out of what Python functions return.
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

// An array on the points themselves, nothing copied: shape (n, d), or (n,) for one coordinate; read-only. Its
// memory is the library's, and valid no longer than that.
nb::object view_of(const PointBatch& points);
// The same on values, to be written to: shape (n, m), or (n,) where `as_vector` is false and there is one.
nb::object view_of(const ValueBatch& values, bool as_vector);

// The number of references that others hold to an array of view_of (by views of it, too).
bool is_kept_elsewhere(const nb::object& array);

// Fills `values` from what a function returned for them: shape (n,) for one value a point (or (n, m) with
// m = 1 where `as_vector`), else (n, m). Throws Error, with a sentence that begins with `what`, for another
// shape and for what are no real numbers.
void copy_values(const nb::object& returned, const ValueBatch& values, bool as_vector, std::string_view what);
// The number of values a point that a function returned for n points: 0 for shape (n,), m for (n, m).
int values_a_point(const nb::object& returned, std::size_t n, std::string_view what);

// New arrays that own what they hold.
DoubleArray new_array(std::span<const double> values);
DoubleArray new_array(std::span<const double> values, std::size_t rows, std::size_t columns);
// A new array of doubles without contents, and where they stand (row by row).
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

// A read-only array of float32 on the memory of a picture of interleaved channels, which `owner` keeps alive:
// shape (height, width, count), or (height, width) for one.
nb::object float_view(const float* data, std::size_t height, std::size_t width, std::size_t channels,
                      std::size_t count, const nb::object& owner);

// A C-contiguous array of doubles of what is given (converted where it has to be), as one run of numbers.
// Throws Error beginning with `what` for what are no real numbers.
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
