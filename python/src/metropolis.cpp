#include "python/src/bindings.h"
#include "python/src/numpy_bridge.h"
#include "python/src/python_function.h"
#include <algorithm>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/metropolis/metropolis_chain.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::python {
namespace {

// A function of one point, passed as a new array.
nb::object at_point(const PythonFunction& f, std::span<const double> x) {
    PyObject* argument[] = {nullptr, nullptr};
    nb::object point = new_array(x);
    argument[1] = point.ptr();
    PyObject* result =
        PyObject_Vectorcall(f.function().ptr(), argument + 1, 1 | PY_VECTORCALL_ARGUMENTS_OFFSET, nullptr);
    if (!result || PyErr_CheckSignals() != 0) throw nb::python_error();
    return nb::steal(result);
}

nb::dict run(nb::object log_density, const std::vector<std::vector<double>>& starts,
             const std::optional<nb::object>& observables, int count, const GaussianWalk& walk,
             MetropolisOptions options) {
    if (starts.empty() || starts[0].empty())
        throw Error("metropolis", "expected a start of at least one coordinate");
    const PythonFunction density(std::move(log_density), "metropolis, log_density");
    std::optional<PythonFunction> observe;
    if (observables) observe.emplace(*observables, "metropolis, observables");
    const std::size_t dimensions = starts[0].size();
    const std::uint64_t kept = options.thin == 0 ? 0 : (options.samples + options.thin - 1) / options.thin;
    const std::size_t shape[] = {static_cast<std::size_t>(std::max(0, options.chains)), kept, dimensions};
    NewArray states = new_array(shape);
    MetropolisResult result;
    {
        nb::gil_scoped_release unlocked;
        result = with_threads(1, [&] {
            return metropolis(
                [&](std::span<const double> x) {
                    nb::gil_scoped_acquire lock;
                    const nb::object value = at_point(density, x);
                    const double p = PyFloat_AsDouble(value.ptr());
                    if (p == -1 && PyErr_Occurred()) throw nb::python_error();
                    return p;
                },
                walk, starts, observe ? count : static_cast<int>(dimensions),
                [&](std::span<const double> x, std::span<double> values) {
                    if (!observe) {
                        std::copy(x.begin(), x.end(), values.begin());
                        return;
                    }
                    nb::gil_scoped_acquire lock;
                    const Numbers n = numbers_of(at_point(*observe, x), observe->what());
                    if (n.values.size() != values.size())
                        throw Error(observe->what(), std::to_string(n.values.size()) +
                                                         " numbers were returned; expected " +
                                                         std::to_string(values.size()));
                    std::copy(n.values.begin(), n.values.end(), values.begin());
                },
                [&](int chain, std::uint64_t k, std::span<const double> x) {
                    std::copy(x.begin(), x.end(),
                              states.data + (static_cast<std::size_t>(chain) * kept + k) * dimensions);
                },
                options);
        });
    }
    nb::dict d;
    auto column = [&](double ChainSummary::*member) {
        std::vector<double> values;
        for (const ChainSummary& s : result.observables) values.push_back(s.*member);
        return new_array(values);
    };
    d["mean"] = column(&ChainSummary::mean);
    d["standard_error"] = column(&ChainSummary::standard_error);
    d["variance"] = column(&ChainSummary::variance);
    d["autocorrelation_time"] = column(&ChainSummary::autocorrelation_time);
    d["effective_sample_size"] = column(&ChainSummary::effective_sample_size);
    d["r_hat"] = column(&ChainSummary::r_hat);
    d["acceptance_rate"] = result.acceptance_rate;
    d["evaluations"] = result.evaluations;
    d["non_finite"] = result.non_finite;
    d["warnings"] = result.warnings;
    d["states"] = states.array;
    return d;
}

} // namespace

void bind_metropolis(nb::module_& m) {
    m.def(
        "metropolis",
        [](nb::object log_density, const std::vector<std::vector<double>>& starts,
           const std::optional<nb::object>& observables, int count, double step,
           const std::vector<double>& scale, bool adapt, int chains, std::uint64_t burn_in,
           std::uint64_t samples, std::uint64_t thin, std::uint64_t seed) {
            return run(std::move(log_density), starts, observables, count, {step, scale, adapt},
                       {chains, burn_in, samples, thin, seed, nullptr});
        },
        "log_density"_a, "starts"_a, "observables"_a.none(), "count"_a, "step"_a, "scale"_a, "adapt"_a,
        "chains"_a, "burn_in"_a, "samples"_a, "thin"_a, "seed"_a,
        "montelux.metropolis, with everything decided.");
}

} // namespace montelux::python
