// Gaussians for a mixture that has too few.
#pragma once

#include <span>
#include <vector>

#include "montelux/mc/integrate/adaptive/gaussian.h"
#include "montelux/mc/integrate/points.h"

namespace montelux {

// Splits each component in two along its longest axis, or in four if there are one or two components.
std::vector<Gaussian> split_gaussians(const std::vector<Gaussian>& components);

// Four, centred at points drawn by weight, half as wide as the whole; none if the weights have no finite sum.
std::vector<Gaussian> scattered_gaussians(const PointBatch& x, std::span<const double> weights);

} // namespace montelux
