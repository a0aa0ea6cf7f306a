// Distributions of microfacet normals: Beckmann's, and GGX with independent masking and shadowing.
#include "test/scene/bsdf_testing.h"
#include <gtest/gtest.h>

#include "montelux/mc/math/special.h"

namespace montelux::testing {
namespace {

const Beckmann beckmann_surfaces[] = {{0.05f, 0.05f}, {0.3f, 0.3f}, {1, 1}, {0.15f, 0.6f}};

// The integral over the slopes of all normals m of f(m) / cos(m)^3, in units of the roughness: the measure of solid
// angles.
template <typename F>
double integral_over_normals(const Beckmann& b, const F& f) {
    constexpr int n = 600;
    constexpr double most = 6, cell = 2 * most / n;
    const auto ax = static_cast<double>(b.alpha_x), ay = static_cast<double>(b.alpha_y);
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = ax * (-most + (i + 0.5) * cell), y = ay * (-most + (j + 0.5) * cell);
            const double z = 1 / std::sqrt(1 + x * x + y * y);
            const Vec3f m(Vec3d{x * z, y * z, z});
            sum += static_cast<double>(f(m)) * z * z * z;
        }
    return sum * cell * cell * ax * ay;
}

TEST(Beckmann, DistributionIsNormalised) {
    for (const Beckmann& b : beckmann_surfaces)
        EXPECT_NEAR(integral_over_normals(b, [&](Vec3f m) { return b.d(m) * m.z; }), 1, 1e-4);
    EXPECT_EQ(beckmann_surfaces[0].d({1, 0, 0}), 0);
    EXPECT_EQ(beckmann_surfaces[0].d(direction(89.9)), 0);
}

// The visible area of the facets is the projected area of the surface times 1 / G1 (Heitz 2014, equation 14).
TEST(Beckmann, ExactLambdaIsThatOfTheDistribution) {
    for (const Beckmann& b : beckmann_surfaces)
        for (double theta : {0.0, 20.0, 50.0, 75.0, 86.0}) {
            const Vec3f w = direction(theta, 40);
            const double area =
                integral_over_normals(b, [&](Vec3f m) { return b.d(m) * std::max(dot(w, m), 0.0f); });
            EXPECT_NEAR(static_cast<double>(w.z * (1 + b.exact_lambda(w))), area, 2e-5 + 1e-4 * area)
                << b.alpha_x << " x " << b.alpha_y << ", " << theta;
        }
}

TEST(Beckmann, RationalLambdaIsCloseToTheExactOne) {
    double greatest = 0;
    for (double theta = 0.5; theta < 90; theta += 0.05) {
        const Vec3f w = direction(theta);
        const double rational = 1 / (1 + static_cast<double>(beckmann_surfaces[2].lambda(w)));
        const double exact = 1 / (1 + static_cast<double>(beckmann_surfaces[2].exact_lambda(w)));
        EXPECT_LE(rational, 1);
        greatest = std::max(greatest, std::abs(rational / exact - 1));
    }
    EXPECT_LT(greatest, 0.0035);
    EXPECT_GT(greatest, 0.001); // it is not the exact one
    EXPECT_EQ(beckmann_surfaces[0].lambda({0, 0, 1}), 0);
}

// In the coordinates p of slopes in which all normals, weighted by their cosines, are uniform in the unit square, the
// density of the visible ones is smooth. False alarms: 20 tests at 1e-8.
TEST(Beckmann, SampledNormalsAreTheVisibleOnes) {
    std::uint64_t seed = 1;
    for (const Beckmann& b : beckmann_surfaces)
        for (double theta : {0.0, 35.0, 70.0, 88.0, 140.0}) {
            const Vec3f w = direction(theta, 250), outside = w.z < 0 ? -w : w;
            const auto draw = [&](Vec2d u) {
                const Vec3f m = b.sample_visible(w, Vec2f(u));
                return Vec2d{normal_cdf(std::sqrt(2.0) * static_cast<double>(m.x / m.z / b.alpha_x)),
                             normal_cdf(std::sqrt(2.0) * static_cast<double>(m.y / m.z / b.alpha_y))};
            };
            const auto pdf = [&](Vec2d p) {
                const double x = static_cast<double>(b.alpha_x) * normal_quantile(p.x) / std::sqrt(2.0);
                const double y = static_cast<double>(b.alpha_y) * normal_quantile(p.y) / std::sqrt(2.0);
                const Vec3d o(outside);
                return std::max(o.x * x + o.y * y + o.z, 0.0) /
                       (o.z * (1 + static_cast<double>(b.exact_lambda(w))));
            };
            const TestResult r =
                rectangle_chi_squared_test(draw, pdf, {0, 0}, {1, 1}, {.samples = 50000, .seed = seed++});
            EXPECT_TRUE(r.passes(1e-8))
                << b.alpha_x << " x " << b.alpha_y << ", " << theta << ": " << r.description;
        }
}

// Also at the ends of the random numbers, and where the surface is seen from its plane.
TEST(Beckmann, SampledNormalsAreUnitVectors) {
    for (const Beckmann& b : beckmann_surfaces)
        for (Vec3f w :
             {direction(0), direction(60, 10), direction(89.9), direction(89.9999), Vec3f{1, 0, 1e-20f}})
            for (float u : {0.0f, 1e-8f, 0.5f, 0x1.fffffep-1f})
                for (float v : {0.0f, 0.3f, 0x1.fffffep-1f}) {
                    const Vec3f m = b.sample_visible(w, {u, v});
                    EXPECT_NEAR(length(m), 1, 1e-5) << w.z << ' ' << u << ' ' << v;
                    EXPECT_GT(m.z, 0);
                    EXPECT_GT(dot(w, m), -1e-5f) << w.z << ' ' << u << ' ' << v;
                }
}

TEST(MicrofacetNormals, AreThoseOfTheirDistribution) {
    const Ggx ggx{0.3f, 0.5f};
    const Beckmann beckmann{0.3f, 0.5f};
    const Vec3f wo = direction(50, 20), wi = direction(70, 130), m = direction(10, 80);
    const Vec2f u{0.2f, 0.7f};
    const MicrofacetNormals correlated(ggx, MicrofacetDistribution::ggx),
        separable(ggx, MicrofacetDistribution::ggx_separable), other(ggx, MicrofacetDistribution::beckmann);
    for (const MicrofacetNormals& n : {correlated, separable}) {
        EXPECT_EQ(n.d(m), ggx.d(m));
        EXPECT_EQ(n.sample_visible(wo, u), ggx.sample_visible(wo, u));
        EXPECT_EQ(n.inverse_masking(wo, wi).visible, 1 / ggx.g1(wo));
    }
    EXPECT_EQ(correlated.inverse_masking(wo, wi).both, ggx.inverse_masking(wo, wi).both);
    EXPECT_FLOAT_EQ(correlated.inverse_masking(wo, wi).both, 1 / ggx.g(wo, wi));
    EXPECT_FLOAT_EQ(separable.inverse_masking(wo, wi).both, 1 / (ggx.g1(wo) * ggx.g1(wi)));
    EXPECT_EQ(other.d(m), beckmann.d(m));
    EXPECT_EQ(other.sample_visible(wo, u), beckmann.sample_visible(wo, u));
    EXPECT_EQ(other.inverse_masking(wo, wi).visible, 1 + beckmann.exact_lambda(wo));
    EXPECT_EQ(other.inverse_masking(wo, wi).both, (1 + beckmann.lambda(wo)) * (1 + beckmann.lambda(wi)));
}

// Factors multiply what the interface reflects and transmits, delta lobes too.
TEST(TintedBsdf, MultipliesBothSides) {
    const SampledSpectrum reflected(0.1f, 0.2f, 0.3f, 0.4f), transmitted(0.9f, 0.8f, 0.7f, 0.6f);
    for (float alpha : {0.0f, 0.4f}) {
        const DielectricBsdfOf<MicrofacetNormals> plain{1.5f, {{alpha, alpha}, MicrofacetDistribution::ggx}};
        const TintedDielectricBsdf tinted{plain, reflected, transmitted};
        TestStream a(3), b(3);
        for (int i = 0; i < 100; ++i) {
            const auto s = plain.sample(direction(40), TransportMode::radiance, a);
            const auto t = tinted.sample(direction(40), TransportMode::radiance, b);
            ASSERT_EQ(s.has_value(), t.has_value());
            if (!s) continue;
            EXPECT_EQ(t->weight, s->weight * (s->transmission ? transmitted : reflected));
            EXPECT_EQ(t->pdf, s->pdf);
            const auto e = plain.evaluate(direction(40), s->wi, TransportMode::radiance, a);
            const auto f = tinted.evaluate(direction(40), s->wi, TransportMode::radiance, b);
            EXPECT_EQ(f.f, e.f * (s->transmission ? transmitted : reflected));
            EXPECT_EQ(f.pdf, e.pdf);
        }
        const SampledSpectrum albedo = tinted.albedo(direction(0));
        for (int k = 0; k < 4; ++k)
            EXPECT_NEAR(albedo[k], 0.04f * reflected[k] + 0.96f * transmitted[k], 1e-6f);
    }
}

} // namespace
} // namespace montelux::testing
