#include "python/src/bindings.h"
#include "python/src/numpy_bridge.h"
#include "python/src/python_function.h"
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "montelux/mc/dist/affine.h"
#include "montelux/mc/dist/distribution.h"
#include "montelux/mc/dist/families.h"
#include "montelux/mc/dist/mixture.h"
#include "montelux/mc/dist/piecewise_1d.h"
#include "montelux/mc/dist/truncated.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux::python {
namespace {

// Applies a function of one number to a number or an array of any shape.
template <typename F>
nb::object elementwise(const nb::object& given, const char* what, const F& f) {
    const Numbers n = numbers_of(given, what);
    NewArray out = new_array(n.shape);
    {
        nb::gil_scoped_release unlocked;
        f(n.values, std::span<double>(out.data, n.values.size()));
    }
    if (n.shape.empty()) return nb::float_(*out.data);
    return out.array;
}

using Of = double (Distribution::*)(double) const;
template <Of of>
nb::object each(const Distribution& d, const nb::object& x) {
    return elementwise(x, "Distribution", [&](std::span<const double> in, std::span<double> out) {
        for (std::size_t i = 0; i < in.size(); ++i) out[i] = (d.*of)(in[i]);
    });
}

nb::object sample(const Distribution& d, const nb::object& u) {
    return elementwise(u, "Distribution.sample", [&](std::span<const double> in, std::span<double> out) {
        require_uniform(in, "Distribution.sample");
        d.sample(in, out);
    });
}

DoubleArray draw(const Distribution& d, std::size_t count, std::uint64_t seed) {
    const std::size_t shape[] = {count};
    NewArray out = new_array(shape);
    {
        nb::gil_scoped_release unlocked;
        const std::span<double> x(out.data, count);
        PhiloxStream numbers(hash_key(seed, 0x64726177u));
        for (double& value : x) value = numbers.next_double();
        d.sample(x, x);
    }
    return out.array;
}

Distribution from_density(nb::object f, double lower, double upper, std::vector<double> break_points,
                          double tolerance) {
    PythonFunction density(std::move(f), "Distribution.from_density");
    nb::gil_scoped_release unlocked;
    return Distribution::from_density(density, lower, upper, {std::move(break_points), tolerance});
}

Distribution tabulated(const nb::object& x, const nb::object& f) {
    const Numbers nodes = numbers_of(x, "Distribution.tabulated, x"),
                  values = numbers_of(f, "Distribution.tabulated, f");
    return Distribution(PiecewiseLinear1D(nodes.values, values.values));
}

Distribution piecewise_constant(const nb::object& values, double lower, double upper) {
    return Distribution(
        PiecewiseConstant1D(numbers_of(values, "Distribution.piecewise_constant").values, lower, upper));
}

Distribution mixture(const std::vector<double>& weights, std::vector<Distribution> components) {
    return Distribution(Mixture<Distribution>(std::span<const double>(weights), std::move(components)));
}

template <typename D, typename... Parameters>
auto family() {
    return [](Parameters... parameters) { return Distribution(D(parameters...)); };
}

void bind_families(nb::class_<Distribution>& c) {
    c.def_static("uniform", family<UniformDistribution, double, double>(), "lower"_a = 0., "upper"_a = 1.,
                 "Density 1 / (upper - lower).")
        .def_static("normal", family<NormalDistribution, double, double>(), "mean"_a = 0., "deviation"_a = 1.,
                    "Normal law of this mean and standard deviation.")
        .def_static("log_normal", family<LogNormalDistribution, double, double>(), "log_mean"_a = 0.,
                    "log_deviation"_a = 1.,
                    "The exponential of a normal variable of this mean and deviation.")
        .def_static("exponential", family<ExponentialDistribution, double>(), "rate"_a,
                    "Density rate exp(-rate x), x >= 0.")
        .def_static("gamma", family<GammaDistribution, double, double>(), "shape"_a, "scale"_a = 1.,
                    "Density proportional to x^(shape - 1) exp(-x / scale), x >= 0.")
        .def_static("chi_squared", family<ChiSquaredDistribution, double>(), "degrees_of_freedom"_a,
                    "The sum of degrees_of_freedom squared standard normal variables.")
        .def_static("beta", family<BetaDistribution, double, double>(), "a"_a, "b"_a,
                    "Density proportional to x^(a-1) (1-x)^(b-1) on [0, 1].")
        .def_static("cauchy", family<CauchyDistribution, double, double>(), "location"_a = 0., "scale"_a = 1.,
                    "Cauchy's (Lorentz') law; scale is the half width at half maximum.")
        .def_static("student_t", family<StudentTDistribution, double, double, double>(),
                    "degrees_of_freedom"_a, "location"_a = 0., "scale"_a = 1., "Student's law.")
        .def_static("laplace", family<LaplaceDistribution, double, double>(), "location"_a = 0.,
                    "scale"_a = 1., "Density exp(-|z|) / (2 scale), z = (x - location) / scale.")
        .def_static("logistic", family<LogisticDistribution, double, double>(), "location"_a = 0.,
                    "scale"_a = 1., "The logistic law.")
        .def_static("pareto", family<ParetoDistribution, double, double>(), "index"_a, "minimum"_a = 1.,
                    "Density proportional to x^-(index + 1) from minimum on.")
        .def_static(
            "power_law", family<PowerLawDistribution, double, double, double>(), "exponent"_a, "lower"_a = 0.,
            "upper"_a = 1.,
            "Density proportional to x^exponent on [lower, upper]; upper may be infinite for exponents "
            "below -1.")
        .def_static("weibull", family<WeibullDistribution, double, double>(), "shape"_a, "scale"_a = 1.,
                    "Weibull's law; Rayleigh's for shape 2.")
        .def_static("triangular", family<TriangularDistribution, double, double, double>(), "lower"_a = 0.,
                    "mode"_a = 0.5, "upper"_a = 1., "Rises linearly to mode, and falls to upper.")
        .def_static("linear", family<LinearDistribution, double, double>(), "lower"_a = 0., "upper"_a = 1.,
                    "Density proportional to x on [lower, upper], lower >= 0.")
        .def_static("quadratic", family<QuadraticDistribution>(), "Density 3 x^2 / 2 on [-1, 1].")
        .def_static("cosine", family<CosineDistribution>(), "Density cos x on [0, pi/2].")
        .def_static("ggx_angle", family<GgxAngleDistribution, double>(), "alpha"_a,
                    "Angle of microfacet normals of the GGX law of this roughness, on [0, pi/2].");
}

} // namespace

void bind_distributions(nb::module_& m) {
    nb::class_<Distribution> c(
        m, "Distribution", nb::dynamic_attr(),
        "A random variable of one real number.\n\n"
        "pdf, cdf, quantile and sample take a number or an array of any shape, and give "
        "the same shape. Nothing of it ever changes.");
    c.def_static(
         "from_density", &from_density, "f"_a, "lower"_a, "upper"_a, "break_points"_a = std::vector<double>(),
         "tolerance"_a = 1e-12,
         "With density proportional to f(x) >= 0 on [lower, upper], whose ends may be infinite. f takes "
         "and returns one number, and is called again by pdf, cdf and quantile. Where f is infinite, "
         "jumps, or has a narrow peak inside, say so by break_points; tolerance is the relative error of "
         "its integral.")
        .def_static("tabulated", &tabulated, "x"_a, "f"_a,
                    "Linear between the nodes (x_i, f_i), f_i >= 0, x increasing.")
        .def_static("piecewise_constant", &piecewise_constant, "values"_a, "lower"_a = 0., "upper"_a = 1.,
                    "Constant on pieces of equal width, with densities proportional to values.")
        .def_static("mixture", &mixture, "weights"_a, "components"_a,
                    "Each value from one of the components, chosen by their weights.");
    bind_families(c);
    c.def(
         "truncated",
         [](const Distribution& d, double a, double b) {
             return Distribution(Truncated<Distribution>(d, a, b));
         },
         "lower"_a, "upper"_a, "Restricted to an interval; either end may be infinite.")
        .def(
            "scaled",
            [](const Distribution& d, double scale, double shift) {
                return Distribution(Affine<Distribution>(d, scale, shift));
            },
            "scale"_a, "shift"_a = 0., "The law of shift + scale X; a negative scale reflects.")
        .def("__repr__",
             [](const Distribution& d) {
                 std::ostringstream text;
                 text << "Distribution(lower=" << d.lower() << ", upper=" << d.upper()
                      << ", median=" << d.quantile(0.5) << ")";
                 return text.str();
             })
        .def_prop_ro("lower", &Distribution::lower, "Lower end of the support.")
        .def_prop_ro("upper", &Distribution::upper, "Upper end of the support.")
        .def("pdf", &each<&Distribution::pdf>, "x"_a.none(), "Probability density, per unit of x.")
        .def("cdf", &each<&Distribution::cdf>, "x"_a, "Probability of values up to x.")
        .def("cdf_complement", &each<&Distribution::cdf_complement>, "x"_a,
             "Probability of values above x, with all digits.")
        .def("quantile", &each<&Distribution::quantile>, "p"_a, "The x with cdf(x) = p.")
        .def("quantile_complement", &each<&Distribution::quantile_complement>, "q"_a,
             "The x with cdf_complement(x) = q.")
        .def("sample", &sample, "u"_a.none(),
             "Values for uniform numbers u in [0, 1): the quantile, always finite, so that the order of "
             "low-discrepancy points is kept.")
        .def("draw", &draw, "count"_a, "seed"_a = 0, "Independent values, shape (count,).");
}

} // namespace montelux::python
