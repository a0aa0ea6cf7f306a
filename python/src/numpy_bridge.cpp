#include "python/src/numpy_bridge.h"

#include <cstring>
#include <string>

#include "montelux/mc/math/error.h"

#if defined(__GNUC__) // macros of NumPy's own
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wcast-qual"
#pragma GCC diagnostic ignored "-Wconversion"
#endif
#include <numpy/arrayobject.h>

namespace montelux::python {
namespace {

std::string shape_text(PyArrayObject* array) {
    std::string text = "(";
    const int dimensions = PyArray_NDIM(array);
    for (int d = 0; d < dimensions; ++d) text += (d ? ", " : "") + std::to_string(PyArray_DIM(array, d));
    return text + (dimensions == 1 ? ",)" : ")");
}

PyArrayObject* as_array(const nb::object& o) { return reinterpret_cast<PyArrayObject*>(o.ptr()); }

nb::object stolen(PyObject* o) {
    if (!o) throw nb::python_error();
    return nb::steal(o);
}

nb::object view(const double* data, std::size_t count, int columns, std::size_t stride, bool as_matrix,
                int flags) {
    npy_intp shape[2] = {static_cast<npy_intp>(count), columns};
    npy_intp strides[2] = {sizeof(double), static_cast<npy_intp>(stride * sizeof(double))};
    return stolen(PyArray_New(&PyArray_Type, as_matrix ? 2 : 1, shape, NPY_DOUBLE, strides,
                              const_cast<double*>(data), 0, flags, nullptr));
}

// Arrays of other libraries, by DLPack.
nb::object as_numpy(const nb::handle& given, std::string_view what) {
    return nb::module_::import_("montelux._foreign_arrays")
        .attr("as_numpy")(given, nb::str(what.data(), what.size()));
}

// An array of doubles from any argument, in any memory order.
nb::object double_array(const nb::handle& given, int requirements, std::string_view what) {
    auto fail = [what](const std::string& sentence) -> void { throw Error(what, sentence); };
    if (given.is_none()) fail("returned None; expected an array of numbers (is there a return statement?)");
    if (PyArray_Check(given.ptr()) && !PyArray_CheckExact(given.ptr()) && nb::hasattr(given, "mask"))
        fail("a masked array was found; replace the masked values, for example by y.filled(0)");
    const bool foreign = !PyArray_Check(given.ptr()) && nb::hasattr(given, "__dlpack__");
    nb::object any =
        foreign ? as_numpy(given, what) : stolen(PyArray_FromAny(given.ptr(), nullptr, 0, 0, 0, nullptr));
    const int type = PyArray_TYPE(as_array(any));
    if (PyTypeNum_ISCOMPLEX(type))
        fail("complex numbers were found; expected real ones. The real and the imaginary part can be two "
             "components: np.stack([y.real, y.imag], axis=-1)");
    if (!PyTypeNum_ISNUMBER(type) && !PyTypeNum_ISBOOL(type))
        fail("objects of type '" + std::string(nb::type_name(given.type()).c_str()) +
             "' were found that are not all numbers; expected an array of real numbers");
    return stolen(PyArray_FromArray(as_array(any), PyArray_DescrFromType(NPY_DOUBLE),
                                    requirements | NPY_ARRAY_FORCECAST));
}

bool is_plain(PyObject* o) {
    return PyArray_CheckExact(o) && PyArray_TYPE(reinterpret_cast<PyArrayObject*>(o)) == NPY_DOUBLE &&
           PyArray_ISBEHAVED_RO(reinterpret_cast<PyArrayObject*>(o));
}

[[noreturn]] void wrong_shape(PyArrayObject* array, std::size_t n, int components, std::string_view what) {
    const std::string points = std::to_string(n);
    std::string sentence = "an array of shape " + shape_text(array) + " was returned for " + points +
                           (n == 1 ? " point" : " points") + "; expected shape ";
    if (components < 0)
        sentence += "(" + points + ",), or (" + points + ", m) for m components";
    else if (components == 0)
        sentence += "(" + points + ",)";
    else
        sentence += "(" + points + ", " + std::to_string(components) + ")";
    if (PyArray_NDIM(array) == 0)
        sentence +=
            ": one value per point (sums over the coordinates of points need axis=1; for a function of "
            "a single point say batch=False)";
    throw Error(what, sentence);
}

void copy_column(const char* from, npy_intp step, std::span<double> to) {
    if (step == sizeof(double)) {
        std::memcpy(to.data(), from, to.size_bytes());
        return;
    }
    for (double& value : to) {
        std::memcpy(&value, from, sizeof value);
        from += step;
    }
}

} // namespace

bool is_array(PyObject* o) { return PyArray_Check(o); }

void import_numpy() {
    if (PyArray_ImportNumPyAPI() < 0) throw nb::python_error();
}

nb::object view_of(const PointBatch& points) {
    return view(points.data(), points.count(), points.dimensions(), points.stride(), points.dimensions() != 1,
                0);
}

nb::object view_of(const ValueBatch& values, bool as_vector) {
    const double* first = values.component(0).data();
    const std::size_t stride = values.components() > 1
                                   ? static_cast<std::size_t>(values.component(1).data() - first)
                                   : values.count();
    return view(first, values.count(), values.components(), stride, as_vector, NPY_ARRAY_WRITEABLE);
}

bool is_kept_elsewhere(const nb::object& array) { return Py_REFCNT(array.ptr()) > 1; }

void copy_values(const nb::object& returned, const ValueBatch& values, bool as_vector,
                 std::string_view what) {
    const nb::object doubles =
        is_plain(returned.ptr()) ? returned : double_array(returned, NPY_ARRAY_ALIGNED, what);
    PyArrayObject* array = as_array(doubles);
    const auto n = static_cast<npy_intp>(values.count());
    const int components = values.components();
    const bool fits = as_vector ? PyArray_NDIM(array) == 2 && PyArray_DIM(array, 0) == n &&
                                      PyArray_DIM(array, 1) == components
                                : PyArray_NDIM(array) == 1 && PyArray_DIM(array, 0) == n;
    if (!fits) wrong_shape(array, values.count(), as_vector ? components : 0, what);
    const char* data = PyArray_BYTES(array);
    for (int c = 0; c < components; ++c)
        copy_column(data + (as_vector ? c * PyArray_STRIDE(array, 1) : 0), PyArray_STRIDE(array, 0),
                    values.component(c));
}

int values_a_point(const nb::object& returned, std::size_t n, std::string_view what) {
    const nb::object doubles = double_array(returned, 0, what);
    PyArrayObject* array = as_array(doubles);
    const bool fits = PyArray_NDIM(array) >= 1 && PyArray_NDIM(array) <= 2 &&
                      PyArray_DIM(array, 0) == static_cast<npy_intp>(n);
    if (!fits || (PyArray_NDIM(array) == 2 && PyArray_DIM(array, 1) == 0)) wrong_shape(array, n, -1, what);
    return PyArray_NDIM(array) == 1 ? 0 : static_cast<int>(PyArray_DIM(array, 1));
}

NewArray new_array(std::span<const std::size_t> shape) {
    std::vector<npy_intp> dimensions(shape.begin(), shape.end());
    auto array = nb::borrow<DoubleArray>(
        stolen(PyArray_SimpleNew(static_cast<int>(dimensions.size()), dimensions.data(), NPY_DOUBLE)));
    return {array, static_cast<double*>(PyArray_DATA(as_array(array)))};
}

NewIndexArray new_index_array(std::span<const std::size_t> shape) {
    std::vector<npy_intp> dimensions(shape.begin(), shape.end());
    auto array = nb::borrow<IndexArray>(
        stolen(PyArray_SimpleNew(static_cast<int>(dimensions.size()), dimensions.data(), NPY_INT64)));
    return {array, static_cast<std::int64_t*>(PyArray_DATA(as_array(array)))};
}

DoubleArray new_array(std::span<const double> values) {
    const std::size_t shape[] = {values.size()};
    NewArray a = new_array(shape);
    if (!values.empty()) std::memcpy(a.data, values.data(), values.size_bytes());
    return a.array;
}

DoubleArray new_array(std::span<const double> values, std::size_t rows, std::size_t columns) {
    const std::size_t shape[] = {rows, columns};
    NewArray a = new_array(shape);
    if (!values.empty()) std::memcpy(a.data, values.data(), values.size_bytes());
    return a.array;
}

nb::object float_view(const float* data, std::size_t height, std::size_t width, std::size_t channels,
                      std::size_t count, const nb::object& owner) {
    const auto pixel = static_cast<npy_intp>(channels * sizeof(float));
    npy_intp shape[3] = {static_cast<npy_intp>(height), static_cast<npy_intp>(width),
                         static_cast<npy_intp>(count)};
    npy_intp strides[3] = {pixel * static_cast<npy_intp>(width), pixel, sizeof(float)};
    nb::object array = stolen(PyArray_New(&PyArray_Type, count == 1 ? 2 : 3, shape, NPY_FLOAT, strides,
                                          const_cast<float*>(data), 0, 0, nullptr));
    nb::object base = owner;
    if (PyArray_SetBaseObject(as_array(array), base.release().ptr()) < 0) throw nb::python_error();
    return array;
}

Numbers numbers_of(const nb::handle& given, std::string_view what) {
    Numbers numbers;
    numbers.array = double_array(given, NPY_ARRAY_CARRAY_RO, what);
    PyArrayObject* array = as_array(numbers.array);
    numbers.values = {static_cast<const double*>(PyArray_DATA(array)),
                      static_cast<std::size_t>(PyArray_SIZE(array))};
    for (int d = 0; d < PyArray_NDIM(array); ++d)
        numbers.shape.push_back(static_cast<std::size_t>(PyArray_DIM(array, d)));
    return numbers;
}

Rows::Rows(const nb::handle& given, std::size_t size_, std::string_view what)
    : numbers(numbers_of(given, what)), size(size_) {
    if (numbers.shape.empty() || numbers.shape.back() != size)
        throw Error(what, "expected an array of shape (n, " + std::to_string(size) + ")");
}

std::vector<std::size_t> Rows::shape() const { return {numbers.shape.begin(), numbers.shape.end() - 1}; }

std::vector<std::size_t> Rows::shape(std::size_t n) const {
    std::vector<std::size_t> shape = numbers.shape;
    shape.back() = n;
    return shape;
}

void require_uniform(std::span<const double> u, std::string_view what) {
    for (const double v : u)
        if (!(v >= 0 && v <= 1))
            throw Error(what,
                        "the uniform number " + std::to_string(v) + " was given; expected numbers in [0, 1]");
}

} // namespace montelux::python
