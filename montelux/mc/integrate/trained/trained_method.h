// Integration by a density that another integration trained.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/trained/trained_density.h"

namespace montelux {

// Samples a trained density from the first evaluation on: for an integrand that resembles the one it was
// trained on. A mixture stays as it is and is sampled by replicates of scrambled Sobol' points; a map starts
// Vegas, which goes on refining it. Unbiased for any density: a bad one costs samples.
struct Trained {
    static constexpr std::string_view name = "trained";

    TrainedDensity density;
    int replicates = 16; // of a mixture, at least 4

    // Throws Error where the integrand's domain takes another number of uniform variables.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
