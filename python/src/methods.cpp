#include "python/src/bindings.h"
#include "python/src/c_function.h"
#include "python/src/names.h"
#include "python/src/numpy_bridge.h"
#include "python/src/python_function.h"
#include "python/src/recipe.h"
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/integrate/auto.h"
#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/cubature/cubature.h"
#include "montelux/mc/integrate/grid/grid.h"
#include "montelux/mc/integrate/method.h"
#include "montelux/mc/integrate/metropolis/metropolis.h"
#include "montelux/mc/integrate/quasi/quasi.h"
#include "montelux/mc/integrate/stratified/recursive.h"
#include "montelux/mc/integrate/stratified/stratified.h"
#include "montelux/mc/integrate/techniques/control_variate.h"
#include "montelux/mc/integrate/techniques/importance.h"
#include "montelux/mc/integrate/techniques/multiple_importance.h"
#include "montelux/mc/integrate/trained/trained_method.h"
#include "montelux/mc/integrate/vegas/vegas.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::python {
namespace {

// A class of settings, each with its default; `_method` is the Method for integrate().
template <typename S, typename... Extra>
nb::class_<S> method_class(nb::module_& m, const char* name, const char* doc, const Extra&... extra) {
    nb::class_<S> c(m, name, doc, extra...);
    c.def("_method", [](const S& settings) { return Method(settings); });
    c.attr("name") = nb::str(S::name.data(), S::name.size());
    return c;
}

template <typename S>
nb::class_<S> bare_method(nb::module_& m, const char* name, const char* doc) {
    return method_class<S>(m, name, doc).def(nb::init<>());
}

template <typename S>
void grid(nb::module_& m, const char* name, const char* doc) {
    method_class<S>(m, name, doc)
        .def(
            "__init__", [](S* s, std::uint64_t cells) { new (s) S{cells}; }, nb::kw_only(), "cells"_a = 0)
        .def_rw("cells", &S::cells, "Cells along each variable; 0: as many as the budget allows.");
}

constexpr Names<ImportancePoints, 2> importance_points{
    "points", {{{"random", ImportancePoints::random}, {"sobol", ImportancePoints::sobol}}}};
constexpr Names<Allocation, 2> allocations{
    "allocation", {{{"proportional", Allocation::proportional}, {"neyman", Allocation::neyman}}}};
constexpr Names<Vegas::Points, 2> vegas_points{
    "points", {{{"stratified", Vegas::Points::stratified}, {"sobol", Vegas::Points::sobol}}}};

MisHeuristic heuristic_of(const std::string& name, std::optional<double> parameter) {
    MisHeuristic h =
        name == "balance"  ? MisHeuristic::balance()
        : name == "power"  ? MisHeuristic::power(parameter.value_or(2))
        : name == "cutoff" ? MisHeuristic::cutoff(parameter.value_or(0.1))
        : name == "maximum"
            ? MisHeuristic::maximum()
            : throw Error("weights", unknown_name(name, "heuristic",
                                                  {{"balance", "power", "cutoff", "maximum", "optimal"}}));
    return h;
}

void bind_vegas(nb::module_& m) {
    using Edges = std::vector<std::vector<double>>;
    nb::class_<AdaptiveMap>(m, "AdaptiveMap",
                            "A map of the unit cube, coordinate by coordinate, that follows an integrand: "
                            "what Vegas learns, to be kept and used again.")
        .def(nb::init<int, int>(), "dimensions"_a, "increments"_a = 128)
        .def(nb::init<const Edges&>(), "edges"_a)
        .def_prop_ro("dimensions", &AdaptiveMap::dimensions, "Variables.")
        .def_prop_ro("increments", &AdaptiveMap::increments, "Pieces of the map in each variable.")
        .def(
            "edges",
            [](const AdaptiveMap& map, int d) {
                if (d < 0 || d >= map.dimensions())
                    throw Error("AdaptiveMap.edges", "there is no variable " + std::to_string(d));
                return new_array(map.edges(d));
            },
            "variable"_a, "The edges of the pieces of one variable, from 0 to 1, shape (increments + 1,).")
        .def("save", nb::overload_cast<const std::string&>(&AdaptiveMap::save, nb::const_), "path"_a,
             "Writes the map to a file, whole or not at all.")
        .def_static("load", nb::overload_cast<const std::string&>(&AdaptiveMap::load), "path"_a,
                    "Reads a file that save() wrote.");

    auto vegas = method_class<Vegas>(
        m, "Vegas", "VEGAS+ (Lepage 2021): a map that learns, on adaptive strata or on Sobol' points.");
    vegas
        .def(
            "__init__",
            [](Vegas* v, const std::string& points, double alpha, double beta, int training_iterations,
               std::uint64_t training_evaluations, int increments, double uniform_share, int replicates,
               std::optional<AdaptiveMap> map) {
                new (v) Vegas{vegas_points.value(points),
                              alpha,
                              beta,
                              training_iterations,
                              training_evaluations,
                              increments,
                              uniform_share,
                              replicates,
                              std::move(map)};
            },
            nb::kw_only(), "points"_a = "stratified", "alpha"_a = 1.0, "beta"_a = 0.75,
            "training_iterations"_a = 5, "training_evaluations"_a = 0, "increments"_a = 512,
            "uniform_share"_a = 0.05, "replicates"_a = 16, "map"_a = nb::none())
        .def_prop_rw(
            "points", [](const Vegas& v) { return vegas_points.name(v.points); },
            [](Vegas& v, const std::string& s) { v.points = vegas_points.value(s); },
            "'stratified' (random, in hypercubes) or 'sobol' (randomised Sobol' points).")
        .def_rw("alpha", &Vegas::alpha, "How fast the map moves; 0 keeps it.")
        .def_rw("beta", &Vegas::beta, "Points of a hypercube grow as the spread of its values to this power.")
        .def_rw("training_iterations", &Vegas::training_iterations,
                "Iterations at the start that train alone.")
        .def_rw("training_evaluations", &Vegas::training_evaluations,
                "Of each of them; 0: the method decides.")
        .def_rw("increments", &Vegas::increments, "Largest number of pieces of the map per variable.")
        .def_rw("uniform_share", &Vegas::uniform_share, "Uniform points for each point of the estimate.")
        .def_rw("replicates", &Vegas::replicates, "Of Sobol' points.")
        .def_rw("map", &Vegas::map, nb::for_setter(nb::arg("map").none()),
                "Where the map starts (AdaptiveMap); None: the identity.");
    m.def(
        "train_map",
        [](const nb::object& f, const Domain& domain, std::uint64_t evaluations, const Vegas& settings,
           std::uint64_t seed, int components) {
            const Integrand integrand = integrand_of(f, components, false);
            nb::gil_scoped_release unlocked;
            return with_threads(
                1, [&] { return train_map(Evaluator(integrand, domain), evaluations, settings, seed); });
        },
        "f"_a, "domain"_a, "evaluations"_a, "settings"_a, "seed"_a, "components"_a);
}

void bind_sampling(nb::module_& m) {
    method_class<Quasi>(
        m, "Quasi",
        "Randomised quasi-Monte Carlo: low-discrepancy points, with an error from the spread of "
        "independent randomisations.")
        .def(
            "__init__",
            [](Quasi* q, const std::string& points, const std::optional<std::string>& random,
               int replicates) {
                Quasi settings{point_sets.value(points), std::nullopt, replicates};
                if (random) settings.randomisation = randomisations.value(*random);
                new (q) Quasi(settings);
            },
            nb::kw_only(), "points"_a = "sobol", "randomisation"_a = nb::none(), "replicates"_a = 0)
        .def_prop_rw(
            "points", [](const Quasi& q) { return point_sets.name(q.points); },
            [](Quasi& q, const std::string& s) { q.points = point_sets.value(s); }, "The point set's name.")
        .def_prop_rw(
            "randomisation",
            [](const Quasi& q) -> std::optional<std::string_view> {
                if (!q.randomisation) return std::nullopt;
                return randomisations.name(*q.randomisation);
            },
            [](Quasi& q, const std::optional<std::string>& s) {
                q.randomisation = s ? std::optional(randomisations.value(*s)) : std::nullopt;
            },
            nb::for_setter(nb::arg("randomisation").none()),
            "'none', 'shift', 'digit_permutation', 'scramble'; None: scrambling where it exists, else a "
            "shift.")
        .def_rw("replicates", &Quasi::replicates, "Randomisations, at least 2; 0: the method decides.");
    method_class<Stratified>(m, "Stratified", "Stratified sampling on a grid, jittered.")
        .def(
            "__init__",
            [](Stratified* s, std::uint64_t strata, const std::string& allocation, int pilot) {
                new (s) Stratified{strata, allocations.value(allocation), pilot};
            },
            nb::kw_only(), "strata"_a = 0, "allocation"_a = "proportional", "pilot"_a = 4)
        .def_rw("strata", &Stratified::strata, "Along each variable; 0: the finest that the budget allows.")
        .def_prop_rw(
            "allocation", [](const Stratified& s) { return allocations.name(s.allocation); },
            [](Stratified& s, const std::string& name) { s.allocation = allocations.value(name); },
            "'proportional' or 'neyman' (by the spread within strata, from a pilot).")
        .def_rw("pilot", &Stratified::pilot, "Samples in each stratum, for Neyman's allocation.");
    method_class<Recursive>(m, "Recursive", "Recursive stratified sampling, in the spirit of MISER.")
        .def(
            "__init__", [](Recursive* r, double pilot) { new (r) Recursive{pilot}; }, nb::kw_only(),
            "pilot"_a = 0.1)
        .def_rw("pilot", &Recursive::pilot, "Part of the evaluations, in [0.01, 0.5].");
    method_class<Adaptive>(m, "Adaptive",
                           "A trained mixture density, sampled by randomised Sobol' points: for peaks and "
                           "ridges in 2 to 30 variables.")
        .def(
            "__init__",
            [](Adaptive* a, int replicates, double uniform_share, double training_share) {
                new (a) Adaptive{replicates, uniform_share, training_share};
            },
            nb::kw_only(), "replicates"_a = 16, "uniform_share"_a = 1 / 16., "training_share"_a = 0.25)
        .def_rw("replicates", &Adaptive::replicates, "Independent parts of the estimate, at least 4.")
        .def_rw("uniform_share", &Adaptive::uniform_share,
                "Share of the points that stay uniform, in (0, 1).")
        .def_rw("training_share", &Adaptive::training_share,
                "Share of the evaluations that the target is expected to need, in (0, 1).");
    method_class<Metropolis>(
        m, "Metropolis",
        "Metropolis-Hastings chains for the shape of the integrand, importance sampling for "
        "its normalisation.")
        .def(
            "__init__",
            [](Metropolis* s, int chains, std::uint64_t burn_in, std::uint64_t pilot) {
                new (s) Metropolis{chains, burn_in, pilot};
            },
            nb::kw_only(), "chains"_a = 32, "burn_in"_a = 500, "pilot"_a = 4096)
        .def_rw("chains", &Metropolis::chains, "Chains.")
        .def_rw("burn_in", &Metropolis::burn_in, "States of each chain that are left out.")
        .def_rw("pilot", &Metropolis::pilot, "Uniform points among which the starts are chosen.");
}

// A Technique itself, or one of distributions, as an object of Python.
nb::object technique_of(const nb::object& given) {
    return nb::isinstance<Technique>(given) ? given : nb::type<Technique>()(given);
}

void bind_densities(nb::module_& m) {
    method_class<Trained>(m, "Trained",
                          "A density that another integration trained, sampled from the first evaluation on.",
                          nb::dynamic_attr())
        .def(
            "__init__",
            [](nb::pointer_and_handle<Trained> self, const nb::object& density, int replicates) {
                if (!nb::isinstance<TrainedDensity>(density))
                    throw Error("Trained", "expected a TrainedDensity, such as the `density` of a Result");
                new (self.p) Trained{nb::cast<TrainedDensity>(density), replicates};
                note_recipe(self.h, nb::make_tuple(density));
            },
            "density"_a, nb::kw_only(), "replicates"_a = 16,
            nb::sig("def __init__(self, density: TrainedDensity, *, replicates: int = 16) -> None"))
        .def_rw("replicates", &Trained::replicates,
                "Independent parts of the estimate by a mixture, at least 4.");
    method_class<Importance>(m, "Importance",
                             "Importance sampling: the mean of f / p over points of density p.",
                             nb::dynamic_attr())
        .def(
            "__init__",
            [](nb::pointer_and_handle<Importance> self, const nb::object& technique,
               const std::string& points, bool probes) {
                const nb::object t = technique_of(technique);
                new (self.p) Importance{nb::cast<Technique>(t), importance_points.value(points), probes};
                note_recipe(self.h, nb::make_tuple(t));
            },
            "technique"_a, nb::kw_only(), "points"_a = "random", "probes"_a = true,
            nb::sig("def __init__(self, technique: Technique | Distribution | Sequence[Distribution], *, "
                    "points: str = 'random', probes: bool = True) -> None"))
        .def_prop_rw(
            "points", [](const Importance& s) { return importance_points.name(s.points); },
            [](Importance& s, const std::string& name) { s.points = importance_points.value(name); },
            "'random', or 'sobol': scrambled, in replicates.")
        .def_rw("probes", &Importance::probes,
                "Whether a few uniform points look for places that the density leaves out.");
    method_class<MultipleImportance>(
        m, "MultipleImportance",
        "Multiple importance sampling (Veach 1997): several techniques, combined by "
        "weights.",
        nb::dynamic_attr())
        .def(
            "__init__",
            [](nb::pointer_and_handle<MultipleImportance> self, const std::vector<nb::object>& techniques,
               const std::string& weights, std::optional<double> parameter, bool probes) {
                MultipleImportance settings;
                nb::list pairs;
                for (const nb::object& t : techniques) {
                    const bool pair = nb::isinstance<nb::tuple>(t);
                    const nb::object technique = technique_of(pair ? nb::object(t[0]) : t);
                    const std::uint64_t samples = pair ? nb::cast<std::uint64_t>(t[1]) : 1;
                    settings.techniques.push_back({nb::cast<Technique>(technique), samples});
                    pairs.append(nb::make_tuple(technique, samples));
                }
                if (weights == "optimal")
                    settings.weights = OptimalWeights{};
                else
                    settings.weights = heuristic_of(weights, parameter);
                settings.probes = probes;
                new (self.p) MultipleImportance(std::move(settings));
                nb::dict named;
                named["weights"] = weights;
                named["parameter"] = parameter;
                note_recipe(self.h, nb::make_tuple(nb::tuple(pairs)), named);
            },
            "techniques"_a, nb::kw_only(), "weights"_a = "balance", "parameter"_a = nb::none(),
            "probes"_a = true,
            "techniques: a list of techniques, or of pairs (technique, samples of it in each round). "
            "weights: "
            "'balance', 'power' (parameter: the exponent, 2), 'cutoff' (the fraction of the largest below "
            "which "
            "a technique is dropped, 0.1), 'maximum' or 'optimal' (Kondapaneni et al. 2019).")
        .def_rw("probes", &MultipleImportance::probes,
                "Whether a few uniform points look for places that all densities leave out.");
    method_class<ControlVariate>(
        m, "ControlVariate",
        "Control variates: functions with known integrals take away the variance that "
        "they explain.",
        nb::dynamic_attr())
        .def(
            "__init__",
            [](nb::pointer_and_handle<ControlVariate> self, const nb::object& controls,
               std::vector<double> integrals, int components) {
                new (self.p)
                    ControlVariate{integrand_of(PythonFunction(controls, "controls"), components, false),
                                   std::move(integrals)};
                nb::dict named;
                named["components"] = components;
                note_recipe(self.h, nb::make_tuple(controls), named);
            },
            "controls"_a, "integrals"_a, nb::kw_only(), "components"_a = 0,
            "controls: a batch function as an integrand is; one control as shape (n,), m of them "
            "(components=m) "
            "as (n, m). integrals: over the domain, one per control.")
        .def_rw("integrals", &ControlVariate::integrals, "Of the controls over the domain.");
}

} // namespace

void bind_methods(nb::module_& m) {
    nb::class_<Method>(m, "Method", "An estimator with its settings, as the integrator takes it.")
        .def_prop_ro("name", &Method::name);
    bare_method<Auto>(m, "Auto", "Picks the method, and says which and why.");
    bare_method<BasicMonteCarlo>(m, "BasicMonteCarlo", "The mean over independent uniform points.");
    bind_sampling(m);
    bind_vegas(m);
    bind_densities(m);
    method_class<VegasSobol>(m, "VegasSobol", "Vegas on Sobol' points, under a name of its own.")
        .def(
            "__init__", [](VegasSobol* s, const Vegas& settings) { new (s) VegasSobol{settings}; },
            "settings"_a = Vegas{})
        .def_rw("settings", &VegasSobol::settings, "The settings of Vegas.");
    method_class<Cubature>(
        m, "Cubature", "Deterministic adaptive cubature: many digits of smooth integrands of few variables.")
        .def(
            "__init__", [](Cubature* s, std::uint64_t bytes) { new (s) Cubature{bytes}; }, nb::kw_only(),
            "max_memory"_a = std::uint64_t{1} << 30)
        .def_rw("max_memory", &Cubature::max_memory, "Bytes that the regions may take.");
    grid<RiemannSum>(m, "RiemannSum", "Left Riemann sums on a grid.");
    grid<MidpointRule>(m, "MidpointRule", "The midpoint rule on a grid.");
    grid<TrapezoidRule>(m, "TrapezoidRule", "The trapezoid rule on a grid.");
    m.def(
        "mis_weights",
        [](const nb::object& q, const std::string& heuristic, std::optional<double> parameter) {
            const Numbers n = numbers_of(q, "mis_weights");
            if (n.shape.empty()) throw Error("mis_weights", "expected an array of shape (..., techniques)");
            const MisHeuristic h = heuristic_of(heuristic, parameter);
            for (double density : n.values)
                if (!(density >= 0)) throw Error("mis_weights", "a density is negative or NaN");
            const std::size_t k = n.shape.back();
            NewArray w = new_array(n.shape);
            for (std::size_t i = 0; k > 0 && i + k <= n.values.size(); i += k)
                for (std::size_t j = 0; j < k; ++j) w.data[i + j] = mis_weight(h, n.values.subspan(i, k), j);
            return w.array;
        },
        "q"_a.none(), "heuristic"_a = "balance", "parameter"_a = nb::none(),
        "Weights of multiple importance sampling, shape (..., techniques) as q: q[..., i] = n_i p_i(x), the "
        "samples of technique i times its density. heuristic: 'balance', 'power' (parameter: the exponent, "
        "2), "
        "'cutoff' (0.1) or 'maximum'.");
}

} // namespace montelux::python
