// Integrals of positive functions given by their logarithms: log Z with its error.
#pragma once

#include "montelux/mc/integrate/integrate.h"

namespace montelux {

// Z = integral of exp(log f), whose value may lie far outside the range of doubles.
struct LogIntegrationResult {
    double log_value = 0; // log Z; -infinity where Z is zero
    // Standard error of log Z to first order: the relative error of Z. Accurate while it is much smaller than
    // 1.
    double log_error = 0;
    double log_reference = 0; // natural logarithm of the unit of `relative`
    // The integration itself: values and errors are of Z exp(-log_reference).
    IntegrationResult relative;
};

// Like integrate(), for log f with one component; -infinity is an f of zero. `budget.relative_error` is the
// error of log Z; an absolute error of Z throws Error. Progress reports values relative to a reference that
// moves as larger values appear.
//
//     auto result = integrate_log([](double x) { return -5000 - x * x / 2; }, Domain({{-inf, inf}}),
//                                 Method(), {.relative_error = 1e-6}); // log_value = -5000 + log(2 pi) / 2
LogIntegrationResult integrate_log(const Integrand& log_f, const Domain& domain, const Method& method = {},
                                   const Budget& budget = {}, const IntegrationOptions& options = {});

} // namespace montelux
