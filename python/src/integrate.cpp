#include "montelux/mc/integrate/integrate.h"

#include "python/src/bindings.h"
#include "python/src/c_function.h"
#include "python/src/interruptible.h"
#include "python/src/numpy_bridge.h"
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "montelux/mc/integrate/integrate_log.h"
#include "montelux/mc/integrate/interruptible.h"
#include "montelux/mc/integrate/trained/trained_density.h"

namespace montelux::python {
namespace {

// Columns: evaluations, value, standard error, seconds.
DoubleArray history_of(const IntegrationResult& r) {
    std::vector<double> rows;
    for (const IterationRecord& h : r.history)
        rows.insert(rows.end(), {static_cast<double>(h.evaluations), h.value, h.standard_error, h.seconds});
    return new_array(rows, r.history.size(), 4);
}

// log Z with its error in the first line, then to_string of the result.
std::string text_of(const LogIntegrationResult& r) {
    const std::string all = to_string(r.relative);
    return "log Z = " + to_string(Estimate{r.log_value, r.log_error}) + all.substr(all.find('\n'));
}

const IntegrationResult& run_of(const IntegrationResult& r) { return r; }
const IntegrationResult& run_of(const LogIntegrationResult& r) { return r.relative; }

// f, whose exceptions after a request to stop belong to it: the processes that evaluate f have been ended.
Integrand until_cancelled(const Integrand& f, const CancelFlag& cancel) {
    return f
        .with_function([f, &cancel](const PointBatch& x, ValueBatch y) {
            try {
                f(x, y);
            } catch (const nb::python_error&) {
                if (!cancel.requested()) throw;
                throw IntegrandInterrupted{};
            }
        })
        .with_device(f.on_device());
}

template <typename Integrate>
auto run(const Integrate& integrate, const nb::object& f, int components, bool into, const Domain& domain,
         const Method& method, const Budget& budget, IntegrationOptions options, const nb::object& progress,
         CancelFlag& cancel) {
    const Integrand integrand = until_cancelled(integrand_of(f, components, into), cancel);
    const InterruptibleRun here(cancel);
    options.cancel = &cancel;
    if (!progress.is_none()) {
        // Called between steps, while the result is this scope's.
        options.progress = [&](const IntegrationResult& r) {
            nb::gil_scoped_acquire lock;
            try {
                if (progress(nb::cast(r, nb::rv_policy::copy)).is(nb::handle(Py_False))) cancel.request();
            } catch (const nb::python_error& error) {
                if (!InterruptibleRun::interrupt(error)) throw;
            }
        };
    }
    nb::gil_scoped_release unlocked;
    auto result = integrate(integrand, domain, method, budget, options);
    const bool has_value = !run_of(result).history.empty();
    if (here.is_inside_interrupted() || (run_of(result).stop == StopReason::interrupted && !has_value))
        throw IntegrandInterrupted{};
    return result;
}

// Binds a function with the arguments of montelux::integrate.
template <typename Integrate>
void bind_call(nb::module_& m, const char* name, const char* help, const Integrate& integrate) {
    m.def(
        name,
        [integrate](const nb::object& f, int components, bool into, const Domain& domain,
                    const Method& method, double relative_error, double absolute_error, bool vector_norm,
                    std::uint64_t evaluations, double time, std::uint64_t seed, int threads,
                    bool throw_non_finite, bool covariance, const nb::object& progress,
                    const std::string& checkpoint, double checkpoint_every, bool resume, CancelFlag& cancel) {
            IntegrationOptions options;
            options.seed = seed;
            options.threads = threads;
            options.non_finite = throw_non_finite ? NonFinitePolicy::throw_error : NonFinitePolicy::skip;
            options.full_covariance = covariance;
            options.checkpoint = checkpoint;
            options.checkpoint_every = std::chrono::duration<double>(checkpoint_every);
            options.resume = resume;
            const Budget budget{relative_error, absolute_error, evaluations,
                                std::chrono::duration<double>(time),
                                vector_norm ? ErrorNorm::vector : ErrorNorm::component};
            return run(integrate, f, components, into, domain, method, budget, std::move(options), progress,
                       cancel);
        },
        "f"_a, "components"_a, "into"_a, "domain"_a, "method"_a, "relative_error"_a, "absolute_error"_a,
        "vector_norm"_a, "evaluations"_a, "time"_a, "seed"_a, "threads"_a, "throw_non_finite"_a,
        "covariance"_a, "progress"_a.none(), "checkpoint"_a, "checkpoint_every"_a, "resume"_a, "cancel"_a,
        help);
}

} // namespace

void bind_integrate(nb::module_& m) {
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const IntegrandInterrupted&) {
            PyErr_SetNone(PyExc_KeyboardInterrupt);
        }
    });
    nb::class_<CancelFlag>(m, "CancelFlag", "A request to stop, from any thread.")
        .def(nb::init<>())
        .def("request", &CancelFlag::request);
    nb::class_<IntegrationResult>(m, "IntegrationResult",
                                  "What the integrator returns; montelux.Result is made of it.")
        .def_prop_ro("value", [](const IntegrationResult& r) { return new_array(r.value); })
        .def_prop_ro("standard_error", [](const IntegrationResult& r) { return new_array(r.standard_error); })
        .def_prop_ro("covariance",
                     [](const IntegrationResult& r) -> std::optional<DoubleArray> {
                         const std::size_t n = r.value.size();
                         if (r.covariance.size() != n * n) return std::nullopt;
                         return new_array(r.covariance, n, n);
                     })
        .def_ro("statistical", &IntegrationResult::statistical)
        .def_ro("evaluations", &IntegrationResult::evaluations)
        .def_ro("non_finite", &IntegrationResult::non_finite)
        .def_prop_ro("first_non_finite_point",
                     [](const IntegrationResult& r) { return new_array(r.first_non_finite_point); })
        .def_prop_ro("history", &history_of)
        .def_ro("chi_squared", &IntegrationResult::chi_squared)
        .def_ro("degrees_of_freedom", &IntegrationResult::degrees_of_freedom)
        .def_ro("p_value", &IntegrationResult::p_value)
        .def_ro("method", &IntegrationResult::method)
        .def_ro("reason", &IntegrationResult::reason)
        .def_prop_ro("stop", [](const IntegrationResult& r) { return to_string(r.stop); })
        .def_ro("warnings", &IntegrationResult::warnings)
        .def_ro("notes", &IntegrationResult::notes)
        .def_ro("checkpoint_refused_because", &IntegrationResult::checkpoint_refused_because)
        .def_ro("seconds", &IntegrationResult::seconds)
        .def_prop_ro("density",
                     [](const IntegrationResult& r) -> std::optional<TrainedDensity> {
                         if (!r.density) return std::nullopt;
                         return *r.density;
                     })
        .def("__str__", [](const IntegrationResult& r) { return to_string(r); });

    nb::class_<LogIntegrationResult>(m, "LogIntegrationResult",
                                     "What integrate_log returns; montelux.LogResult is made of it.")
        .def_ro("log_value", &LogIntegrationResult::log_value)
        .def_ro("log_error", &LogIntegrationResult::log_error)
        .def_ro("log_reference", &LogIntegrationResult::log_reference)
        .def_ro("relative", &LogIntegrationResult::relative)
        .def("__str__", &text_of);

    m.def(
        "concise",
        [](double value, double error) {
            return to_string(Estimate{value, error});
        },
        "value"_a, "standard_error"_a, "1.2345(67): the error in units of the last digits.");
    bind_call(
        m, "integrate",
        "montelux.integrate, with everything decided. components 0: one value per point, as shape (n,).",
        [](auto&&... arguments) { return integrate(arguments...); });
    bind_call(m, "integrate_log", "montelux.integrate_log, with everything decided, as integrate.",
              [](auto&&... arguments) { return integrate_log(arguments...); });
    m.def(
        "values_a_point",
        [](const nb::object& returned, std::size_t n) { return values_a_point(returned, n, "integrand"); },
        "returned"_a.none(), "n"_a,
        "Components of what an integrand returned for n points: 0 for shape (n,), m for (n, m).");
}

} // namespace montelux::python
