// The front door: integrate a function over a domain until an error, a budget or a time is reached.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/evaluator.h"
#include "montelux/mc/integrate/integrand.h"
#include "montelux/mc/integrate/method.h"
#include "montelux/mc/integrate/result.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {

// Limits of a run, of which the first reached ends it, and settings common to all methods.
struct Budget {
    // Each component stops at whichever of the two errors is larger; zero means none. The errors are one
    // standard deviation.
    double relative_error = 0, absolute_error = 0;
    // 0: no limit if there is a target error or a time, else one million. Steps whose values are so far from
    // 1 (beyond 1e-60 or 1e138) that squares lose digits are repeated at another scale, even beyond the
    // limit.
    std::uint64_t evaluations = 0;
    // Wall time, including earlier parts of a resumed run; 0: no limit. The last steps are shortened to fit;
    // a step that does not finish in time is discarded.
    std::chrono::duration<double> time{0};
};

struct IntegrationOptions {
    std::uint64_t seed = 0;
    // 0: one per processor. The result does not depend on it.
    int threads = 0;
    NonFinitePolicy non_finite = NonFinitePolicy::skip;
    // Covariances of the components; without them memory grows linearly with their number.
    bool full_covariance = true;
    // Called between steps, from the thread that called integrate().
    std::function<void(const IntegrationResult&)> progress = {};
    const CancelFlag* cancel = nullptr;
    // File of the running state, written every `checkpoint_every` and at the end; an existing file becomes
    // CHECKPOINT.previous. With `resume` the run continues from it if it exists, or from the previous one if
    // it is damaged. Empty: none. Four extra evaluations of the integrand detect a different integrand.
    std::string checkpoint = {};
    std::chrono::duration<double> checkpoint_every{60};
    bool resume = false;
};

// The integral of f over the domain. With relative error 0 and absolute error 0 the evaluations or the time
// must be limited (default: one million evaluations). Throws Error for arguments that make no sense, for a
// method that cannot do the problem, for an integrand that is nowhere finite, and for files that cannot be
// written; rethrows what f throws.
//
// A target does not count while all values are zero, up to a million evaluations. Cancelling and the time
// limit take effect between evaluations of f and discard the current step, so a run that ends before its
// first step has no value (zero evaluations, infinite error).
//
//     auto result = integrate([](double x) { return std::sin(x); }, Domain::interval(0, pi / 2),
//                             Method(), {.relative_error = 1e-6});
IntegrationResult integrate(const Integrand& f, const Domain& domain, const Method& method = {},
                            const Budget& budget = {}, const IntegrationOptions& options = {});

} // namespace montelux
