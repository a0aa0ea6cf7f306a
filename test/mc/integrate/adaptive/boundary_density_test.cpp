#include "test/mc/integrate/adaptive/uniform_points.h"
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/adaptive/boundary_density.h"

namespace montelux {
namespace {

double pdf_at(double x) {
    double p = 1;
    multiply_boundary_pdf({&x, 1}, {&p, 1});
    return p;
}
// In closed form.
double cdf_at(double x) { return x < 0.5 ? 0.5 * std::cbrt(2 * x) : 1 - 0.5 * std::cbrt(2 * (1 - x)); }

TEST(BoundaryDensity, SamplesInvertTheDistributionFunction) {
    const PointBuffer u = uniform_points(2000, 1, 5);
    std::vector<double> x(u.count()), p(u.count(), 2.0);
    sample_boundary(u.view().coordinate(0), x, p);
    for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(cdf_at(x[i]), u.view()(i, 0), 1e-5);
        EXPECT_NEAR(p[i], 2 * pdf_at(x[i]), 1e-12 * p[i]); // what was there is multiplied
    }
}

TEST(BoundaryDensity, IsTheDerivativeOfTheDistributionFunction) {
    for (double x : {1e-9, 1e-4, 0.03, 0.3, 0.49, 0.51, 0.8, 0.97, 1 - 1e-4}) {
        const double h = 1e-4 * std::min(x, 1 - x);
        const double slope = (cdf_at(x + h) - cdf_at(x - h)) / (2 * h);
        EXPECT_NEAR(pdf_at(x), slope, 1e-6 * slope) << x;
    }
}

TEST(BoundaryDensity, StaysInsideTheInterval) {
    for (double u : {0.0, 0x1p-64, 0.5, 1 - 0x1p-53}) {
        double x, p = 1;
        sample_boundary({&u, 1}, {&x, 1}, {&p, 1});
        EXPECT_GT(x, 0);
        EXPECT_LT(x, 1);
        EXPECT_TRUE(std::isfinite(p) && p > 0);
    }
    EXPECT_TRUE(std::isfinite(pdf_at(0)));
    EXPECT_TRUE(std::isfinite(pdf_at(1)));
}

} // namespace
} // namespace montelux
