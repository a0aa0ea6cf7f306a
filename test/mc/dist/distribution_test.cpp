#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/dist/affine.h"
#include "montelux/mc/dist/distribution.h"
#include "montelux/mc/dist/families.h"
#include "montelux/mc/dist/mixture.h"
#include "montelux/mc/dist/piecewise_1d.h"
#include "montelux/mc/dist/truncated.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {
namespace {

static_assert(TwoTailedDistribution1D<Distribution>);
static_assert(Distribution1D<PiecewiseConstant1D>);
static_assert(Distribution1D<PiecewiseLinear1D>);
static_assert(TwoTailedDistribution1D<Truncated<Distribution>>);
static_assert(TwoTailedDistribution1D<Mixture<Distribution>>);

TEST(Distribution, IsWhatItHolds) {
    NormalDistribution held(1, 2);
    Distribution d = held;
    Distribution copy = d;
    for (double x : {-20.0, 0.0, 3.5}) {
        EXPECT_EQ(copy.pdf(x), held.pdf(x));
        EXPECT_EQ(copy.cdf(x), held.cdf(x));
        EXPECT_EQ(copy.cdf_complement(x), held.cdf_complement(x));
    }
    for (double p : {1e-200, 0.25, 0.99}) {
        EXPECT_EQ(copy.quantile(p), held.quantile(p));
        EXPECT_EQ(copy.quantile_complement(p), held.quantile_complement(p));
        EXPECT_EQ(copy.sample(p), held.sample(p));
    }
    EXPECT_EQ(d.lower(), held.lower());
    EXPECT_EQ(d.upper(), held.upper());
    ASSERT_NE(d.as<NormalDistribution>(), nullptr);
    EXPECT_EQ(d.as<NormalDistribution>(), copy.as<NormalDistribution>()); // shared, not copied
    EXPECT_EQ(d.as<CauchyDistribution>(), nullptr);
    d = Distribution::from(ExponentialDistribution(1));
    EXPECT_EQ(d.lower(), 0);
    EXPECT_EQ(copy.quantile(0.5), 1); // the other one is as it was
}

TEST(Distribution, ManyValuesAtOnce) {
    Distribution d = GammaDistribution(2, 3);
    std::vector<double> xi{0, 0.1, 0.5, 0.999}, x(4), p(4);
    d.sample(xi, x);
    d.pdf(x, p);
    for (std::size_t i = 0; i < xi.size(); ++i) {
        EXPECT_EQ(x[i], d.sample(xi[i]));
        EXPECT_EQ(p[i], d.pdf(x[i]));
    }
    EXPECT_THROW(d.sample(xi, std::span(x).first(3)), Error);
    EXPECT_THROW(d.pdf(x, std::span(p).first(3)), Error);
}

TEST(Distribution, FromADensity) {
    Distribution d = Distribution::from_density([](double x) { return x; }, 2, 4);
    for (double xi : {0.0, 0.3, 0.9}) EXPECT_NEAR(d.quantile(xi), 2 * std::sqrt(3 * xi + 1), 1e-13);
    Distribution in_pieces = Distribution::from_density([](double x) { return 1 / std::sqrt(std::abs(x)); },
                                                        -1, 1, {.break_points = {0}});
    EXPECT_NEAR(in_pieces.quantile(0.25), -0.25, 1e-11);
    EXPECT_THROW(Distribution::from_density([](double x) { return x; }, -1, 1), Error);
}

// What a program reads from its input, transformed and combined at run time.
TEST(Distribution, TransformsAndCombines) {
    Distribution base = NormalDistribution();
    Distribution d = Mixture<>({1, 1}, {shifted(base, 2), Truncated(base, -1, 0)});
    auto r =
        interval_chi_squared_test([&](double xi) { return d.sample(xi); }, [&](double x) { return d.pdf(x); },
                                  -3, 7, {.samples = 50000, .cells_x = 50});
    EXPECT_TRUE(r.passes(significance)) << r.description;
    EXPECT_NEAR(d.pdf(2), 0.5 * NormalDistribution().pdf(0), 1e-15);
}

template <typename D>
void expect_cdf_and_quantile(const D& d) {
    EXPECT_EQ(d.cdf(d.lower() - 1), 0);
    EXPECT_EQ(d.cdf(d.lower()), 0);
    EXPECT_EQ(d.cdf(d.upper()), 1);
    EXPECT_EQ(d.cdf(d.upper() + 1), 1);
    Distribution erased = d;
    for (double xi : {0.001, 0.2, 0.5, 0.9, 0.999}) {
        EXPECT_EQ(d.quantile(xi), d.sample(xi).x);
        EXPECT_NEAR(d.cdf(d.quantile(xi)), xi, 1e-14);
        EXPECT_NEAR(erased.cdf_complement(erased.quantile_complement(xi)), xi, 1e-13);
    }
}

TEST(Distribution, HoldsTables) {
    std::vector<double> values{0, 1, 0, 3, 0.25, 2};
    expect_cdf_and_quantile(PiecewiseConstant1D(values, -1, 2));
    expect_cdf_and_quantile(PiecewiseLinear1D(values, -1, 2));
    // A table is truncated as any other law is.
    Truncated cut(PiecewiseConstant1D(values, 0, 6), 3.5, 5);
    EXPECT_NEAR(cut.mass(), 1.75 / 6.25, 1e-15);
    EXPECT_NEAR(cut.pdf(4.5), 0.25 / 1.75, 1e-15);
}

} // namespace
} // namespace montelux
