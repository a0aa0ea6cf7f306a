// Control variates (A11): functions with known integrals take away the variance that they explain.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// The mean of f - sum_k beta_k (h_k - H_k) over uniform points, where H_k is the integral of control h_k over
// the domain. beta is found by regression of f on the controls (one beta for each component of f), from the
// samples of all steps before the one that it is used in: so each step is unbiased whatever beta is, steps
// are uncorrelated, and they are averaged by their numbers of samples (Owen 2013, "Monte Carlo theory,
// methods and examples", section 8.9). The first step is a pilot and gives beta only. Controls that depend on
// others linearly are left out. Where the samples contradict a known integral by far, there is a warning.
struct ControlVariate {
    static constexpr std::string_view name = "control_variate";

    Integrand controls; // a component each
    std::vector<double> integrals;

    // Throws Error where controls and integrals differ in number, or controls and domain do not fit.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
