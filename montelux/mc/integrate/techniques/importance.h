// Importance sampling (A3, A4): the mean of f / p over points that follow any density p.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/techniques/technique.h"

namespace montelux {

enum class ImportancePoints : std::uint8_t {
    random,
    sobol // scrambled, in replicates (see Quasi)
};

// The estimator 1/N * sum of f(X_i) / p(X_i), X_i ~ p; unbiased if p > 0 wherever f is not zero. A small part
// of the evaluations, 1 to 32, probes uniform points of the domain for places where that does not hold, and
// warns with the point and the size of what is missing. A density below zero or NaN ends the
// integration with an Error; a point drawn where the technique's own density is zero counts as not finite.
// Points outside a box contribute zero, and the integrand is not called there.
struct Importance {
    static constexpr std::string_view name = "importance";

    Technique technique;
    ImportancePoints points = ImportancePoints::random;
    bool probes = true;

    // Throws Error where technique and domain have different dimensions.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
