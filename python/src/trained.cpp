#include "python/src/bindings.h"
#include "python/src/c_function.h"
#include "python/src/numpy_bridge.h"
#include "python/src/python_function.h"
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/trained/expectations.h"
#include "montelux/mc/integrate/trained/observables.h"
#include "montelux/mc/integrate/trained/samples.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"

namespace montelux::python {
namespace {

DoubleArray array_of(const PointBatch& x) {
    const std::size_t shape[] = {x.count(), static_cast<std::size_t>(x.dimensions())};
    NewArray made = new_array(shape);
    for (std::size_t i = 0; i < x.count(); ++i) x.gather(i, made.data + i * shape[1]);
    return made.array;
}

UnweightingOptions options_of(bool log, std::uint64_t seed, int threads, std::uint64_t max_draws,
                              bool throw_non_finite) {
    UnweightingOptions options;
    options.form = log ? IntegrandForm::logarithm : IntegrandForm::value;
    options.seed = seed;
    options.threads = threads;
    options.max_draws = max_draws;
    options.non_finite = throw_non_finite ? NonFinitePolicy::throw_error : NonFinitePolicy::skip;
    return options;
}

bool throws(const std::string& policy) {
    if (policy != "skip" && policy != "throw")
        throw Error("non_finite", "'" + policy + "' was given; expected 'skip' or 'throw'");
    return policy == "throw";
}

// f of points in the shape that the integrand had when the density was trained.
PythonFunction function_of(const TrainedDensity& density, const nb::object& f, const char* what) {
    const nb::object region = nb::getattr(nb::find(density), "_region", nb::none());
    return {nb::module_::import_("montelux._regions").attr("with_points_of")(region, f), what};
}

// A function of points with as many components as it returns at a few points of the density.
Integrand observables_of(const TrainedDensity& density, const nb::object& f, const char* what) {
    const PythonFunction function = function_of(density, f, what);
    PointBuffer v(64, density.unit().dimensions() + 1);
    fill_random(v, 0, 0, 0);
    UnitDraws draws;
    density.unit().draw(v, draws);
    PointBuffer x(draws.index.size(), density.domain().dimensions());
    std::vector<double> volume(draws.index.size(), 1.0);
    density.domain().map(draws.u, x, volume);
    const int components = values_a_point(function.call(x), x.count(), what);
    return integrand_of(function, components, false);
}

// A function of Python, or in machine code in any form that integrate() takes, which the object keeps alive.
struct GivenFunction {
    nb::object owner;
    Integrand integrand;
};
GivenFunction given_function(const TrainedDensity& density, const nb::object& f, const char* what) {
    nb::object native =
        nb::module_::import_("montelux._c_functions").attr("c_function")(f, density.domain().dimensions());
    if (native.is_none()) return {nb::object(), integrand_of(function_of(density, f, what), 0, false)};
    Integrand integrand = integrand_of(native, 0, false);
    return {std::move(native), std::move(integrand)};
}

// Numbers of an array.
std::vector<double> vector_of(const nb::handle& given, const char* what) {
    const Numbers n = numbers_of(given, what);
    return {n.values.begin(), n.values.end()};
}

std::string text_of(const Samples& s) {
    return std::to_string(s.count()) + " samples, integral " +
           to_string(Estimate{s.integral.value, s.integral.standard_error});
}

void bind_samples(nb::module_& m) {
    nb::class_<Samples>(m, "Samples",
                        "Points with weights that follow a target f: sum(weights * h(points)) / sum(weights) "
                        "is the mean of h over f / Z.")
        .def_prop_ro(
            "points", [](const Samples& s) { return array_of(s.x); }, "Shape (n, d).")
        .def_prop_ro(
            "weights", [](const Samples& s) { return new_array(s.weight); }, "Shape (n,).")
        .def_prop_ro(
            "values", [](const Samples& s) { return new_array(s.f.component(0)); },
            "The target at the points (its logarithm where log=True), shape (n,).")
        .def_prop_ro(
            "integral", [](const Samples& s) { return s.integral.value; },
            "The integral Z of the target; with log=True Z exp(-log_reference).")
        .def_prop_ro(
            "standard_error", [](const Samples& s) { return s.integral.standard_error; }, "Of it.")
        .def_ro("log_reference", &Samples::log_reference)
        .def_prop_ro("effective_sample_size", &Samples::effective_sample_size, "(sum w)^2 / sum w^2.")
        .def_ro("draws", &Samples::draws, "Draws of the density.")
        .def_ro("evaluations", &Samples::evaluations, "Of the target.")
        .def_prop_ro("non_finite", [](const Samples& s) { return s.non_finite.count; })
        .def_ro("warnings", &Samples::warnings, "Reasons why the samples may not follow f.")
        .def("__len__", &Samples::count)
        .def("__repr__", &text_of);
    nb::class_<UnweightedSamples, Samples>(m, "UnweightedSamples",
                                           "Samples by rejection: nearly all weights are 1 (or -1).")
        .def_ro("max_weight", &UnweightedSamples::max_weight, "Of f / p.")
        .def_prop_ro(
            "efficiency", [](const UnweightedSamples& s) { return s.efficiency.value; },
            "Kept draws over all draws.")
        .def_prop_ro(
            "efficiency_error", [](const UnweightedSamples& s) { return s.efficiency.standard_error; },
            "Its standard error.")
        .def_ro("overweight", &UnweightedSamples::overweight, "Samples that weigh more than 1.")
        .def_ro("largest_weight", &UnweightedSamples::largest_weight, "The largest weight.")
        .def_ro("overweight_share", &UnweightedSamples::overweight_share,
                "What is beyond 1 in all of them, as a share of all weight.");
    nb::class_<Expectations>(
        m, "Expectations", "Integrals of f h and means of h over f / Z, for observables h, with covariances.")
        .def_prop_ro(
            "integral", [](const Expectations& e) { return e.integral.at(0); },
            "The integral Z of the target; with log=True Z exp(-log_reference).")
        .def_prop_ro(
            "standard_error", [](const Expectations& e) { return std::sqrt(e.integral_covariance.at(0)); },
            "Of it.")
        .def_prop_ro(
            "value", [](const Expectations& e) { return new_array(std::span(e.integral).subspan(1)); },
            "The integrals of f h, shape (m,).")
        .def_prop_ro(
            "covariance",
            [](const Expectations& e) {
                const auto n = e.integral.size();
                std::vector<double> inner;
                for (std::size_t a = 1; a < n; ++a)
                    for (std::size_t b = 1; b < n; ++b) inner.push_back(e.integral_covariance[a * n + b]);
                return new_array(inner, n - 1, n - 1);
            },
            "Of `value`, shape (m, m).")
        .def_prop_ro(
            "mean", [](const Expectations& e) { return new_array(e.mean()); },
            "The means of h over f / Z, shape (m,).")
        .def_prop_ro(
            "mean_covariance",
            [](const Expectations& e) {
                const auto size = static_cast<std::size_t>(e.observables());
                return new_array(e.mean_covariance(), size, size);
            },
            "Of `mean`, shape (m, m); the normalisation is of the same draws.")
        .def_ro("log_reference", &Expectations::log_reference)
        .def_ro("draws", &Expectations::draws, "Draws of the density.")
        .def_ro("evaluations", &Expectations::evaluations, "Of the target.")
        .def_prop_ro("non_finite", [](const Expectations& e) { return e.non_finite.count; })
        .def_ro("warnings", &Expectations::warnings, "Reasons why the values may be wrong.")
        .def("__repr__", [](const Expectations& e) {
            return std::to_string(e.observables()) + " observables from " + std::to_string(e.draws) +
                   " draws";
        });
}

nb::bytes bytes_of(const TrainedDensity& density) {
    const std::vector<std::uint64_t> words = density.words();
    return nb::bytes(reinterpret_cast<const char*>(words.data()), words.size() * sizeof words[0]);
}
TrainedDensity from_bytes(const nb::bytes& bytes, const Domain* domain) {
    std::vector<std::uint64_t> words(bytes.size() / 8);
    if (!words.empty()) std::memcpy(words.data(), bytes.c_str(), words.size() * 8);
    try {
        return TrainedDensity::from_words(std::move(words), domain);
    } catch (const Error& error) {
        throw Error("TrainedDensity", std::string("the pickle ") + error.what());
    }
}

} // namespace

void bind_trained(nb::module_& m) {
    bind_samples(m);
    nb::class_<TrainedDensity>(
        m, "TrainedDensity", nb::dynamic_attr(),
        "What an integration learned about its integrand (Result.density): to draw samples from, keep in a "
        "file, and use for other integrands. Functions take points in the integrand's shape, (n, d) or (n,), "
        "and return shape (n,). For a density of one variable from a file that is (n,).")
        .def_prop_ro(
            "dimensions", [](const TrainedDensity& d) { return d.domain().dimensions(); },
            "Coordinates of a point.")
        .def_prop_ro(
            "kind", [](const TrainedDensity& d) { return d.unit().map() ? "map" : "mixture"; },
            "'map' (of Vegas) or 'mixture' (of Adaptive).")
        .def_prop_rw("notes", &TrainedDensity::notes, &TrainedDensity::set_notes,
                     "Texts by name that are saved with the density.")
        .def("save", &TrainedDensity::save, "path"_a,
             "Writes a checksummed file, whole or not at all; the one before becomes PATH.previous.")
        .def_static(
            "load",
            [](const std::string& path, const Domain* domain) {
                return domain ? TrainedDensity::load(path, *domain) : TrainedDensity::load(path);
            },
            "path"_a, "domain"_a.none() = nb::none(),
            "Reads a file that save() wrote. A density on something else than ranges needs its domain.")
        .def(
            "pdf",
            [](const TrainedDensity& density, const nb::object& points) {
                const auto d = static_cast<std::size_t>(density.domain().dimensions());
                const Rows rows(points, d, "TrainedDensity.pdf");
                PointBuffer x(rows.count(), static_cast<int>(d));
                for (std::size_t i = 0; i < rows.count(); ++i)
                    for (std::size_t k = 0; k < d; ++k) x(i, static_cast<int>(k)) = rows[i][k];
                std::vector<double> p(rows.count());
                density.pdf(x, p);
                return new_array(p);
            },
            "points"_a, "The density at points of shape (n, d), per unit of volume; ranges only.")
        .def(
            "samples",
            [](const TrainedDensity& density, nb::object f, std::uint64_t n, bool log, std::uint64_t seed,
               int threads, std::uint64_t max_draws, const std::string& non_finite) {
                const UnweightingOptions options =
                    options_of(log, seed, threads, max_draws, throws(non_finite));
                const GivenFunction target = given_function(density, f, "target");
                nb::gil_scoped_release unlocked;
                return weighted_samples(density, target.integrand, n, options);
            },
            "f"_a, "n"_a, nb::kw_only(), "log"_a = false, "seed"_a = 0, "threads"_a = 1, "max_draws"_a = 0,
            "non_finite"_a = "skip",
            "n weighted samples of the target f, whose weights add up to its integral. log: f returns "
            "logarithms.")
        .def(
            "unweighted",
            [](const TrainedDensity& density, nb::object f, std::uint64_t n, bool log, std::uint64_t seed,
               int threads, std::uint64_t pilot, double overweight_share, std::uint64_t max_draws,
               const std::string& non_finite) {
                UnweightingOptions options = options_of(log, seed, threads, max_draws, throws(non_finite));
                options.pilot = pilot;
                options.overweight_share = overweight_share;
                const GivenFunction target = given_function(density, f, "target");
                nb::gil_scoped_release unlocked;
                return unweighted_samples(density, target.integrand, n, options);
            },
            "f"_a, "n"_a, nb::kw_only(), "log"_a = false, "seed"_a = 0, "threads"_a = 1,
            "pilot"_a = UnweightingOptions().pilot,
            "overweight_share"_a = UnweightingOptions().overweight_share, "max_draws"_a = 0,
            "non_finite"_a = "skip",
            "n samples of the target f by rejection. The maximum weight is that of `pilot` draws, but for "
            "this "
            "share of the integral, whose samples weigh more than 1.")
        .def(
            "expectations",
            [](const TrainedDensity& density, nb::object f, nb::object observables, std::uint64_t draws,
               bool log, std::uint64_t seed, int threads, const std::string& non_finite) {
                const UnweightingOptions options = options_of(log, seed, threads, 0, throws(non_finite));
                const Integrand h = observables_of(density, observables, "observables");
                const GivenFunction target = given_function(density, f, "target");
                nb::gil_scoped_release unlocked;
                return expectations(density, target.integrand, h, draws, options);
            },
            "f"_a, "observables"_a, "draws"_a = 100'000, nb::kw_only(), "log"_a = false, "seed"_a = 0,
            "threads"_a = 1, "non_finite"_a = "skip",
            "Integrals and means of observables over the target f, with their covariances. observables(x) "
            "returns "
            "shape (n,) or (n, m).")
        .def(
            "histogram",
            [](const TrainedDensity& density, nb::object f, nb::object observable, const nb::object& edges,
               std::uint64_t draws, bool log, std::uint64_t seed, int threads,
               const std::string& non_finite) {
                const UnweightingOptions options = options_of(log, seed, threads, 0, throws(non_finite));
                const GivenFunction of_points = given_function(density, observable, "observable");
                const Integrand h = histogram_bins(of_points.integrand, vector_of(edges, "edges"));
                const GivenFunction target = given_function(density, f, "target");
                nb::gil_scoped_release unlocked;
                return expectations(density, target.integrand, h, draws, options);
            },
            "f"_a, "observable"_a, "edges"_a, "draws"_a = 100'000, nb::kw_only(), "log"_a = false,
            "seed"_a = 0, "threads"_a = 1, "non_finite"_a = "skip",
            "The same for the bins of a histogram: `value` is the integral of f over each bin, `mean` its "
            "share.")
        .def("_bytes", &bytes_of)
        .def_static("_from_bytes", &from_bytes, "bytes"_a, "domain"_a.none() = nb::none())
        .def("__repr__", [](const TrainedDensity& d) {
            return std::string("TrainedDensity: ") +
                   (d.unit().uniform() ? "uniform"
                    : d.unit().map()   ? "a map"
                                       : "a mixture") +
                   " on " + d.domain().description();
        });
}

} // namespace montelux::python
