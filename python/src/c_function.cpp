#include "python/src/c_function.h"

#include "python/src/bindings.h"
#include "python/src/devices.h"
#include "python/src/interruptible.h"
#include "python/src/python_function.h"
#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux::python {
namespace {

constexpr std::string_view accepted_signatures =
    "double (double), double (double, void *), double (int, double *), double (int, double *, void *), or "
    "void (int, int, double *, double *) for many points at once (docs/python-integrands.md)";

// Without spaces, const and volatile; what remains of an accepted signature is unambiguous.
std::string without_spaces(std::string_view signature) {
    std::string text(signature);
    for (const std::string_view word : {"const ", "volatile "})
        for (std::size_t at; (at = text.find(word)) != std::string::npos;) text.erase(at, word.size());
    std::erase(text, ' ');
    return text;
}

bool is_contiguous(const PointBatch& x) { return x.dimensions() == 1 || x.stride() == x.count(); }

bool is_contiguous(const ValueBatch& y) {
    return y.components() == 1 || y.component(1).data() == y.component(0).data() + y.count();
}

// From f(int dimensions, double* x), which gets a copy of each point and may change it.
template <typename F>
Integrand of_points(const F& f) {
    return Integrand::batch([f](const PointBatch& x, const ValueBatch& y) {
        // Some points at a time: the coordinates of a single one lie in lines that evict one another.
        constexpr std::size_t block = 16;
        const auto width = static_cast<std::size_t>(x.dimensions());
        std::array<double, 16 * block> small;
        std::vector<double> large(block * width > small.size() ? block * width : 0);
        double* rows = large.empty() ? small.data() : large.data();
        const std::span<double> out = y.component(0);
        for (std::size_t first = 0; first < x.count(); first += block) {
            const std::size_t n = std::min(block, x.count() - first);
            for (std::size_t d = 0; d < width; ++d) {
                const double* from = x.coordinate(static_cast<int>(d)).data() + first;
                for (std::size_t i = 0; i < n; ++i) rows[i * width + d] = from[i];
            }
            for (std::size_t i = 0; i < n; ++i) out[first + i] = f(x.dimensions(), rows + i * width);
        }
    });
}

// f, which also looks for Ctrl-C some twenty times a second, on the thread that is here now.
Integrand interruptible_by_signals(const Integrand& f) {
    using Clock = std::chrono::steady_clock;
    auto next = std::make_shared<Clock::time_point>();
    return f.with_function([f, next, caller = std::this_thread::get_id()](const PointBatch& x, ValueBatch y) {
        f(x, y);
        if (std::this_thread::get_id() != caller || Clock::now() < *next) return;
        *next = Clock::now() + std::chrono::milliseconds(50);
        nb::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw_python_error();
    });
}

} // namespace

CFunction::Function CFunction::function_of(std::uintptr_t address, std::string_view signature,
                                           bool has_data) {
    const std::string form = without_spaces(signature);
    if (address == 0) throw Error("integrand", "a C function without an address was given");
    if (form == "double(double,void*)") return reinterpret_cast<OfNumberWithData>(address);
    if (form == "double(int,double*,void*)") return reinterpret_cast<OfPointWithData>(address);
    if (has_data)
        throw Error("integrand", "user data was given to a C function of signature '" +
                                     std::string(signature) + "', which takes none; expected a void * last");
    if (form == "double(double)") return reinterpret_cast<OfNumber>(address);
    if (form == "double(int,double*)") return reinterpret_cast<OfPoint>(address);
    if (form == "void(int,int,double*,double*)") return reinterpret_cast<OfPoints>(address);
    throw Error("integrand", "a C function of signature '" + std::string(signature) +
                                 "' was given; expected " + std::string(accepted_signatures));
}

CFunction::CFunction(std::uintptr_t address, std::string_view signature, void* user_data, nb::object owner)
    : function_(function_of(address, signature, user_data != nullptr)), user_data_(user_data),
      owner_(std::move(owner)) {}

CFunction CFunction::of_capsule(const nb::object& capsule, nb::object owner) {
    if (!PyCapsule_CheckExact(capsule.ptr()))
        throw Error("integrand", "an object of type '" + std::string(nb::type_name(capsule.type()).c_str()) +
                                     "' was found in a LowLevelCallable; expected a PyCapsule");
    const char* name = PyCapsule_GetName(capsule.ptr());
    void* address = PyCapsule_GetPointer(capsule.ptr(), name);
    void* user_data = address ? PyCapsule_GetContext(capsule.ptr()) : nullptr;
    if (PyErr_Occurred()) throw nb::python_error();
    return {reinterpret_cast<std::uintptr_t>(address), name ? name : "", user_data, std::move(owner)};
}

Integrand CFunction::integrand(int components) const {
    const bool many = std::holds_alternative<OfPoints>(function_);
    if (components > 0 && !many)
        throw Error("integrand", "components=" + std::to_string(components) +
                                     " was given for a C function that returns one number; expected the form "
                                     "void (int, int, double *, double *)");
    struct Make {
        void* data;
        int components;

        Integrand operator()(OfNumber f) const { return Integrand(f); }
        Integrand operator()(OfNumberWithData f) const {
            return Integrand([f, d = data](double x) { return f(x, d); });
        }
        Integrand operator()(OfPoint f) const { return of_points(f); }
        Integrand operator()(OfPointWithData f) const {
            return of_points([f, d = data](int dimensions, double* x) { return f(dimensions, x, d); });
        }
        Integrand operator()(OfPoints f) const {
            const auto call = [f](const PointBatch& x, ValueBatch y) {
                PointBuffer points;
                ValueBuffer values;
                const double* in = x.data();
                double* out = y.component(0).data();
                if (!is_contiguous(x)) {
                    points.resize(x.count(), x.dimensions());
                    for (int d = 0; d < x.dimensions(); ++d)
                        std::ranges::copy(x.coordinate(d), points.coordinate(d).begin());
                    in = points.view().data();
                }
                if (!is_contiguous(y)) {
                    values.resize(y.count(), y.components());
                    out = values.component(0).data();
                }
                f(static_cast<int>(x.count()), x.dimensions(), const_cast<double*>(in), out);
                if (is_contiguous(y)) return;
                for (int c = 0; c < y.components(); ++c)
                    std::ranges::copy(std::as_const(values).component(c), y.component(c).begin());
            };
            return Integrand::batch(call, std::max(components, 1));
        }
    };
    return interruptible_by_signals(std::visit(Make{user_data_, components}, function_));
}

Integrand integrand_of(const nb::object& f, int components, bool into) {
    if (nb::isinstance<CFunction>(f)) return nb::cast<const CFunction&>(f).integrand(components);
    if (nb::isinstance<CompiledFunction>(f)) return nb::cast<const CompiledFunction&>(f).integrand();
    return integrand_of(PythonFunction(f, "integrand"), components, into);
}

void bind_c_functions(nb::module_& m) {
    nb::class_<CFunction>(m, "CFunction",
                          "An integrand in machine code, called without the interpreter's lock.")
        .def_static(
            "at",
            [](std::uintptr_t address, const std::string& signature, nb::object owner) {
                return CFunction(address, signature, nullptr, std::move(owner));
            },
            "address"_a, "signature"_a, "owner"_a,
            "The function at an address with a signature in C; the owner keeps its code alive.")
        .def_static("of_capsule", &CFunction::of_capsule, "capsule"_a, "owner"_a,
                    "The function of a capsule: its name is the signature, its context the user data.");
}

} // namespace montelux::python
