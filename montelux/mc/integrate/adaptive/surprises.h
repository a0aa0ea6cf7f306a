// Gaussians for places where a density is too small for its function.
#pragma once

#include <span>
#include <vector>

#include "montelux/mc/integrate/adaptive/gaussian.h"
#include "montelux/mc/integrate/points.h"

namespace montelux {

struct SurpriseSearch {
    int most = 6;          // Gaussians
    double surprising = 5; // times the mean of h / q
};

// Around the points with the greatest ratio h / q, one after the other (incremental mixture importance
// sampling: Raftery and Bao 2010, "Estimating and Projecting Trends in HIV/AIDS Generalized Epidemics Using
// Incremental Mixture Importance Sampling"). Each Gaussian has the weighted moments of the fewest nearest
// neighbours that determine them. `weights` are h / p for the density p that drew the points.
std::vector<Gaussian> gaussians_at_surprises(const PointBatch& x, std::span<const double> weights,
                                             std::span<const double> ratios,
                                             const SurpriseSearch& settings = {});

} // namespace montelux
