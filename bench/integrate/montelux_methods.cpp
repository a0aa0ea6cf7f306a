#include "bench/integrate/montelux_methods.h"

#include <algorithm>
#include <array>
#include <string>

#include "montelux/mc/integrate/integrate.h"

namespace montelux::bench {

namespace {

Integrand integrand_of(const CountedIntegrand& f, Form form) {
    if (form == Form::scalar) return Integrand([&f](std::span<const double> x) { return f(x.data()); });
    return Integrand::batch([&f](const PointBatch& x, ValueBatch y) {
        std::array<const double*, BenchIntegrand::max_dimensions> columns;
        for (int j = 0; j < x.dimensions(); ++j) columns[j] = x.coordinate(j).data();
        f.evaluate(columns.data(), x.count(), y.component(0).data());
    });
}

Answer run(const montelux::Method& method, const CountedIntegrand& f, const Request& request) {
    const BenchIntegrand& integrand = f.integrand();
    const Domain domain(std::vector<Range>(static_cast<std::size_t>(f.dimensions()),
                                           Range{integrand.lower(), integrand.upper()}));
    Budget budget;
    budget.relative_error = request.relative_error;
    budget.evaluations = request.evaluations;
    IntegrationOptions options;
    options.seed = request.seed;
    options.threads = 1;
    const IntegrationResult result =
        integrate(integrand_of(f, request.form), domain, method, budget, options);
    return {.value = result.value[0],
            .error = result.standard_error[0],
            .converged = request.relative_error > 0 && result.stop == StopReason::error_target,
            .doubtful = !result.doubts.empty(),
            .chosen = result.method,
            .evaluations = {},
            .cpu_seconds = {}};
}

Kind kind_of(std::string_view name) {
    if (name == "auto") return Kind::either;
    for (std::string_view rule : {"cubature", "genz-malik", "gauss-kronrod", "tanh-sinh", "grid", "midpoint",
                                  "trapezoid", "riemann", "quadrature"})
        if (name.find(rule) != std::string_view::npos) return Kind::cubature;
    return Kind::sampling;
}

} // namespace

std::vector<Method> montelux_methods() {
    std::vector<Method> methods;
    for (std::string_view name : montelux::Method::names())
        methods.push_back({.name = "montelux-" + std::string(name),
                           .kind = kind_of(name),
                           .ours = true,
                           .forms = {Form::batch, Form::scalar},
                           .run = [method = montelux::Method::named(name)](const CountedIntegrand& f,
                                                                           const Request& request) {
                               return run(method, f, request);
                           }});
    return methods;
}

} // namespace montelux::bench
