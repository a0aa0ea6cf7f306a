// Deterministic cubature of the package of that name.
#include "bench/integrate/rivals/rivals.h"
#include <cmath>
#include <cubature.h>
#include <vector>

namespace montelux::bench {

namespace {

int call(unsigned, const double* x, void* integrand, unsigned, double* value) {
    *value = static_cast<const CountedIntegrand*>(integrand)->on_unit_cube(x);
    return 0;
}
int call_rows(unsigned, std::size_t n, const double* x, void* integrand, unsigned, double* values) {
    static_cast<const CountedIntegrand*>(integrand)->rows_on_unit_cube(x, n, values);
    return 0;
}

template <auto Scalar, auto Batch>
Answer cubature(const CountedIntegrand& f, const Request& request) {
    const auto d = static_cast<unsigned>(f.dimensions());
    const std::vector<double> lower(d, 0.0), upper(d, 1.0);
    void* integrand = const_cast<CountedIntegrand*>(&f);
    Answer answer;
    if (request.form == Form::scalar)
        Scalar(1, call, integrand, d, lower.data(), upper.data(), request.evaluations, 0,
               request.relative_error, ERROR_INDIVIDUAL, &answer.value, &answer.error);
    else
        Batch(1, call_rows, integrand, d, lower.data(), upper.data(), request.evaluations, 0,
              request.relative_error, ERROR_INDIVIDUAL, &answer.value, &answer.error);
    answer.converged =
        request.relative_error > 0 && answer.error <= request.relative_error * std::abs(answer.value);
    return answer;
}

} // namespace

std::vector<Method> cubature_methods() {
    return {{.name = "hcubature",
             .kind = Kind::cubature,
             .forms = {Form::scalar, Form::batch},
             .run = cubature<&hcubature, &hcubature_v>},
            {.name = "pcubature",
             .kind = Kind::cubature,
             .forms = {Form::scalar, Form::batch},
             .run = cubature<&pcubature, &pcubature_v>}};
}

} // namespace montelux::bench
