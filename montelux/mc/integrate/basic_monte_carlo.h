// Basic Monte Carlo (A2): the mean of the integrand over uniform points.
#pragma once

#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// The estimator V / N * sum of f(X_i), X_i uniform over the domain; error sigma / sqrt(N). Unbiased for any
// integrand that is integrable, honest for any that is square-integrable.
struct BasicMonteCarlo {
    static constexpr std::string_view name = "basic";
    static constexpr FirstLookUse first_look = FirstLookUse::with_target;
    static constexpr bool on_device = true;

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
