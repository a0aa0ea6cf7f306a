#include "bench/integrate/montelux_methods.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <string>

#include "montelux/mc/integrate/integrate.h"

namespace montelux::bench {

namespace {

Integrand integrand_of(const CountedIntegrand& f, Form form) {
    if (form == Form::scalar) return Integrand([&f](std::span<const double> x) { return f(x.data()); });
    return Integrand::batch([&f](const PointBatch& x, ValueBatch y) {
        std::vector<const double*> columns(static_cast<std::size_t>(x.dimensions()));
        for (int j = 0; j < x.dimensions(); ++j) columns[j] = x.coordinate(j).data();
        f.evaluate(columns.data(), x.count(), y.component(0).data());
    });
}

Answer run(const montelux::Method& method, const CountedIntegrand& f, const Request& request) {
    Budget budget;
    budget.relative_error = request.relative_error;
    budget.evaluations = request.evaluations;
    budget.time = std::chrono::duration<double>(request.seconds);
    IntegrationOptions options;
    options.seed = request.seed;
    options.threads = 1;
    const IntegrationResult result =
        integrate(integrand_of(f, request.form), f.problem().domain(), method, budget, options);
    std::string warnings;
    for (const std::string& warning : result.warnings) warnings += (warnings.empty() ? "" : "; ") + warning;
    return {.value = result.value[0],
            .error = result.standard_error[0],
            .converged = request.relative_error > 0 && result.stop == StopReason::error_target,
            .warned = !result.warnings.empty(),
            .chosen = result.method,
            .reason = result.reason,
            .warnings = warnings,
            .out_of_time = result.stop == StopReason::time,
            .evaluations = {},
            .cpu_seconds = {}};
}

bool is_grid(std::string_view name) {
    for (std::string_view grid : {"riemann", "midpoint", "trapezoid", "grid"})
        if (name.find(grid) != std::string_view::npos) return true;
    return false;
}

Kind kind_of(std::string_view name) {
    if (name == "auto") return Kind::either;
    for (std::string_view rule : {"cubature", "genz", "gauss", "tanh", "quadrature"})
        if (name.find(rule) != std::string_view::npos) return Kind::cubature;
    return is_grid(name) ? Kind::cubature : Kind::sampling;
}

// The default method may or may not be among the names.
montelux::Method named(const std::string& name) {
    return montelux::Method().name() == name ? montelux::Method() : montelux::Method::named(name);
}

constexpr std::string_view prefix = "montelux-";

} // namespace

std::vector<Method> montelux_methods() {
    std::vector<Method> methods;
    auto add = [&](const montelux::Method& method) {
        const std::string name = std::string(prefix) + method.name();
        for (const Method& known : methods)
            if (known.name == name) return;
        methods.push_back({.name = name,
                           .kind = kind_of(method.name()),
                           .ours = true,
                           .forms = {Form::batch, Form::scalar},
                           .run = [method](const CountedIntegrand& f,
                                           const Request& request) { return run(method, f, request); },
                           .by_default = !is_grid(method.name())});
    };
    add(montelux::Method());
    for (std::string_view name : montelux::Method::names()) add(montelux::Method::named(name));
    return methods;
}

std::vector<Scaling> measure_scaling(const std::vector<Method>& methods, std::uint64_t evaluations) {
    const Integrand slow([](std::span<const double> x) {
        double t = 0.5 * (x[0] + x[1]);
        for (int i = 0; i < 18; ++i) t = 3.9 * t * (1 - t); // a chain of dependent operations
        return 1 + t;
    });
    const Domain cube = Domain::unit_cube(8);
    std::vector<Scaling> table;
    for (const Method& method : methods) {
        if (!method.ours || method.kind == Kind::cubature) continue;
        std::array<double, 2> seconds;
        for (int threads : {1, 2}) {
            double& best = seconds[threads - 1];
            best = std::numeric_limits<double>::infinity();
            for (int repeat = 0; repeat < 3; ++repeat) {
                Budget budget;
                budget.evaluations = evaluations;
                IntegrationOptions options;
                options.threads = threads;
                const auto begin = std::chrono::steady_clock::now();
                const IntegrationResult result =
                    integrate(slow, cube, named(method.name.substr(prefix.size())), budget, options);
                const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
                best = std::min(best, wall.count() / static_cast<double>(result.evaluations));
            }
        }
        table.push_back({method.name, 1e9 * seconds[0], seconds[0] / seconds[1]});
    }
    return table;
}

} // namespace montelux::bench
