#include "test/mc/integrate/adaptive/uniform_points.h"
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/adaptive/surprises.h"

namespace montelux {
namespace {

double peak(double x, double y, double px, double py, double sigma) {
    return std::exp(-((x - px) * (x - px) + (y - py) * (y - py)) / (2 * sigma * sigma));
}

// Two peaks, of which the density knows the first.
TEST(Surprises, GaussiansStandWhereTheDensityIsTooSmall) {
    const PointBuffer x = uniform_points(8192, 2, 3);
    std::vector<double> weights, ratios;
    for (std::size_t i = 0; i < x.count(); ++i) {
        const double known = peak(x.view()(i, 0), x.view()(i, 1), 0.3, 0.3, 0.1);
        const double unknown = peak(x.view()(i, 0), x.view()(i, 1), 0.8, 0.6, 0.04);
        weights.push_back(known + unknown);
        ratios.push_back(weights.back() / (0.1 + known / (2 * 3.14159 * 0.01)));
    }
    const std::vector<Gaussian> found = gaussians_at_surprises(x, weights, ratios, {.most = 3});
    ASSERT_GE(found.size(), 1u);
    EXPECT_LE(found.size(), 3u);
    for (const Gaussian& g : found) {
        EXPECT_LT(std::hypot(g.mean()[0] - 0.8, g.mean()[1] - 0.6), 0.1);
        EXPECT_LT(g.cholesky()[0], 0.08);
    }
    EXPECT_TRUE(gaussians_at_surprises(x, weights, ratios, {.surprising = 1e6}).empty());
    EXPECT_TRUE(gaussians_at_surprises(x, std::vector<double>(x.count(), 0.0), ratios).empty());
}

} // namespace
} // namespace montelux
