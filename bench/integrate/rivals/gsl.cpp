// GSL's Monte Carlo integrators. A fresh generator and a fresh grid for each run: VEGAS's grid keeps changing
// with its damping of 1.5, and one that was trained for a coarser target does worse than a new one.
#include "bench/integrate/escalation.h"
#include "bench/integrate/rivals/rivals.h"
#include <algorithm>
#include <gsl/gsl_monte_miser.h>
#include <gsl/gsl_monte_plain.h>
#include <gsl/gsl_monte_vegas.h>
#include <gsl/gsl_rng.h>
#include <memory>
#include <vector>

namespace montelux::bench {

namespace {

double call(double* x, std::size_t, void* integrand) {
    return static_cast<const CountedIntegrand*>(integrand)->on_unit_cube(x);
}

// What a run of any of the three needs.
struct Setting {
    std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> generator{gsl_rng_alloc(gsl_rng_mt19937),
                                                                &gsl_rng_free};
    gsl_monte_function function;
    std::vector<double> lower, upper;

    Setting(const CountedIntegrand& f, std::uint64_t seed)
        : function{&call, static_cast<std::size_t>(f.dimensions()), const_cast<CountedIntegrand*>(&f)},
          lower(function.dim, 0.0), upper(function.dim, 1.0) {
        gsl_rng_set(generator.get(), static_cast<unsigned long>(seed) + 1);
    }
};

Answer plain(const CountedIntegrand& f, const Request& request) {
    Setting s(f, request.seed);
    std::unique_ptr<gsl_monte_plain_state, decltype(&gsl_monte_plain_free)> state(
        gsl_monte_plain_alloc(s.function.dim), &gsl_monte_plain_free);
    return escalate(f, request, 10000, {2, 1e9}, [&](std::uint64_t n) {
        Trial trial;
        gsl_monte_plain_init(state.get());
        gsl_monte_plain_integrate(&s.function, s.lower.data(), s.upper.data(), s.function.dim, n,
                                  s.generator.get(), state.get(), &trial.value, &trial.error);
        return trial;
    });
}

Answer miser(const CountedIntegrand& f, const Request& request) {
    Setting s(f, request.seed);
    std::unique_ptr<gsl_monte_miser_state, decltype(&gsl_monte_miser_free)> state(
        gsl_monte_miser_alloc(s.function.dim), &gsl_monte_miser_free);
    return escalate(f, request, 10000, {2, 16}, [&](std::uint64_t n) {
        Trial trial;
        gsl_monte_miser_init(state.get());
        gsl_monte_miser_integrate(&s.function, s.lower.data(), s.upper.data(), s.function.dim, n,
                                  s.generator.get(), state.get(), &trial.value, &trial.error);
        return trial;
    });
}

// Five iterations train the grid and are thrown away, then five count, as in the example of GSL's manual.
Answer vegas(const CountedIntegrand& f, const Request& request) {
    Setting s(f, request.seed);
    constexpr std::size_t iterations = 5;
    return escalate(f, request, 22000, {2, 16}, [&](std::uint64_t n) {
        std::unique_ptr<gsl_monte_vegas_state, decltype(&gsl_monte_vegas_free)> state(
            gsl_monte_vegas_alloc(s.function.dim), &gsl_monte_vegas_free);
        gsl_monte_vegas_params parameters;
        gsl_monte_vegas_params_get(state.get(), &parameters);
        const auto pilot = std::max<std::uint64_t>(2000, n / 40); // an iteration
        auto integrate = [&](std::uint64_t calls, int stage) {
            Trial trial;
            parameters.iterations = iterations;
            parameters.stage = stage;
            gsl_monte_vegas_params_set(state.get(), &parameters);
            gsl_monte_vegas_integrate(&s.function, s.lower.data(), s.upper.data(), s.function.dim, calls,
                                      s.generator.get(), state.get(), &trial.value, &trial.error);
            return trial;
        };
        integrate(pilot, 0);
        Trial trial = integrate((n - iterations * pilot) / iterations, 1); // keeps the grid, forgets the sums
        // Chi-squared per degree of freedom of the iterations; 4.6 has a p-value of 0.001 with 4 of them.
        trial.warned = gsl_monte_vegas_chisq(state.get()) > 4.6;
        return trial;
    });
}

} // namespace

std::vector<Method> gsl_methods() {
    return {{.name = "gsl-plain", .forms = {Form::scalar}, .run = plain},
            {.name = "gsl-miser", .forms = {Form::scalar}, .run = miser},
            {.name = "gsl-vegas", .forms = {Form::scalar}, .run = vegas}};
}

} // namespace montelux::bench
