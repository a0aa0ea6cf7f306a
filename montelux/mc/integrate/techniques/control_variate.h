// Control variates (A11): functions with known integrals remove the variance that they explain.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// The mean of f - sum_k beta_k (h_k - H_k) over uniform points, where H_k is the integral of control h_k over
// the domain. beta is found by regression of f on the controls (one beta for each component of f), from the
// samples of all earlier steps: so each step is unbiased whatever beta is, steps are uncorrelated, and they
// are averaged by their numbers of samples (Owen 2013, "Monte Carlo theory, methods and examples", section
// 8.9). The first step is a pilot for beta. Linearly dependent controls are dropped. If the samples clearly
// contradict a known integral, there is a warning.
struct ControlVariate {
    static constexpr std::string_view name = "control_variate";

    Integrand controls; // one per component
    std::vector<double> integrals;

    // Throws Error where controls and integrals differ in number, or controls and domain do not fit.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
