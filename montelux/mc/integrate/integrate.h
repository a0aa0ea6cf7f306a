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
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

// What a relative error is relative to: each component's value, or the Euclidean norm of all values.
enum class ErrorNorm : std::uint8_t { component, vector };

// Limits of a run, of which the first reached ends it.
struct Budget {
    // Limits of a run with a target error but neither evaluations nor a time.
    static constexpr double default_seconds = 60;
    static constexpr std::uint64_t default_most_evaluations = 1'000'000'000;

    // Each component stops at whichever of the two errors is larger; zero means none. The errors are one
    // standard deviation. A component whose value is zero within three errors is measured against the integral of
    // its absolute values; `notes` of the result say so.
    double relative_error = 0, absolute_error = 0;
    // At most so many. 0: no limit if there is a time, the default limits if there is a target error, else one
    // million.
    std::uint64_t evaluations = 0;
    // Wall time, including earlier parts of a resumed run; 0: no limit. Methods plan for the evaluations that fit
    // into it; a step that does not finish in time is discarded.
    std::chrono::duration<double> time{0};
    ErrorNorm norm = ErrorNorm::component;
};

struct IntegrationOptions {
    std::uint64_t seed = 0;
    // 0: one per processor. The result does not depend on it.
    int threads = 0;
    NonFinitePolicy non_finite = NonFinitePolicy::skip;
    // Covariances of the components; without them memory grows linearly with their number.
    bool full_covariance = true;
    // Called between steps, from the thread that called integrate(). To end the run with its result so far,
    // request `cancel`.
    std::function<void(const IntegrationResult&)> progress = {};
    const CancelFlag* cancel = nullptr;
    // File of the running state, written every `checkpoint_every` and at the end. With `resume` the run continues
    // from it if it exists, or from CHECKPOINT.previous if it is damaged; without, an existing file is an Error.
    // Empty: none. Four extra evaluations of the integrand detect a different integrand.
    std::string checkpoint = {};
    std::chrono::duration<double> checkpoint_every{60};
    bool resume = false;
};

// The integral of f over the domain. Every run ends: by its limits, or by the default ones. Throws Error for arguments that make no sense, for a
// method that cannot do the problem, for an integrand that is nowhere finite, and for files that cannot be
// written; rethrows what f throws.
//
// Most methods begin with a first look at the integrand by scales (FirstLook), whose evaluations count. A result
// is claimed only if it explains the largest values that the run has seen. Where the mass of |f| does not fall
// towards a point or infinity, the run stops as `diverges`.
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
