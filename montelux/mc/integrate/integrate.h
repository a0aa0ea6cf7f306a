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

// When to stop, whichever comes first; and what else is common to all methods.
struct Budget {
    // Each component stops at whichever of the two errors is larger; zero means none. The errors are one
    // standard deviation.
    double relative_error = 0, absolute_error = 0;
    // 0: no limit where an error or a time is asked for, else one million. Steps whose values lie so far from
    // 1 (beyond 1e-60 or 1e138) that squares lose their digits are repeated at another scale, if need be
    // beyond the limit.
    std::uint64_t evaluations = 0;
    // Wall time, of all parts of a run that is resumed; 0: no limit. The last steps are made to fit; a step
    // that is not done when it is over is given up.
    std::chrono::duration<double> time{0};
};

struct IntegrationOptions {
    std::uint64_t seed = 0;
    // 0: one a processor. The result does not depend on it.
    int threads = 0;
    NonFinitePolicy non_finite = NonFinitePolicy::skip;
    // Covariances of the components; without them memory grows linearly with their number.
    bool full_covariance = true;
    // Called between steps, from the thread that called integrate().
    std::function<void(const IntegrationResult&)> progress = {};
    const CancelFlag* cancel = nullptr;
    // Where the running state is kept: written every `checkpoint_every` and at the end, over a file that is
    // there, which becomes CHECKPOINT.previous; a run goes on from it where `resume` is set and the file
    // exists, or from the one before where it is damaged. Empty: nowhere. To tell other integrands apart, the
    // integrand is evaluated at four points beside those of the method.
    std::string checkpoint = {};
    std::chrono::duration<double> checkpoint_every{60};
    bool resume = false;
};

// The integral of f over the domain. With relative error 0 and absolute error 0 the evaluations or the time
// must be limited (default: one million evaluations). Throws Error for arguments that make no sense, for a
// method that cannot do the problem, for an integrand that is nowhere finite, and for files that cannot be
// written; rethrows what f throws.
//
// A target is not believed while nothing but zeros was met, up to a million evaluations. Cancelling and the
// end of the time take effect between evaluations of f; the step that was being made then is given up, so
// that a run which ends before its first step has no value (zero evaluations, infinite error).
//
//     auto result = integrate([](double x) { return std::sin(x); }, Domain::interval(0, pi / 2),
//                             Method(), {.relative_error = 1e-6});
IntegrationResult integrate(const Integrand& f, const Domain& domain, const Method& method = {},
                            const Budget& budget = {}, const IntegrationOptions& options = {});

} // namespace montelux
