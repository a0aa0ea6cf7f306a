// Plastic: its tables against Monte Carlo integrals of the interface, and energy.
#include "test/scene/bsdf_testing.h"
#include <gtest/gtest.h>

#include "montelux/mc/stats/moments.h"

namespace montelux::testing {
namespace {

constexpr MicrofacetDistribution plastic_distributions[] = {
    MicrofacetDistribution::ggx, MicrofacetDistribution::ggx_separable, MicrofacetDistribution::beckmann};

// The mean weight of a lobe of the interface for light from wo(): an estimate of its albedo.
template <typename Direction>
RunningMoments albedo_of_lobe(const DielectricBsdfOf<MicrofacetNormals>& interface, Lobes lobe,
                              const Direction& wo, std::uint64_t seed) {
    TestStream stream(seed);
    RunningMoments m;
    for (int i = 0; i < 50000; ++i) {
        const Vec3f w = wo(stream);
        const auto s = interface.sample_lobes(w, lobe == Lobes::reflection ? 0.0f : 0x1.fffffep-1f,
                                              stream.next_2d(), TransportMode::importance, lobe);
        m.add(s ? static_cast<double>(s->weight[0]) : 0);
    }
    return m;
}

// False alarms: 30 comparisons at 6 standard errors.
TEST(PlasticTable, HoldsIntegralsOfTheInterface) {
    std::uint64_t seed = 1;
    const auto diffuse = [](float side) {
        return [side](auto& stream) { return side * sample_cosine_hemisphere(stream.next_2d()); };
    };
    for (const MicrofacetDistribution d : plastic_distributions)
        for (float alpha : {0.1f, 0.5f}) {
            const PlasticTable& table = plastic_table(alpha, d);
            const DielectricBsdfOf<MicrofacetNormals> interface {
                1.5f, { {alpha, alpha}, d }
            };
            const auto expect = [&](float value, Lobes lobe, const auto& wo) {
                const RunningMoments m = albedo_of_lobe(interface, lobe, wo, seed++);
                EXPECT_NEAR(static_cast<double>(value), m.mean(), 6 * m.standard_error() + 1e-3) << alpha;
            };
            for (double theta : {10.0, 60.0, 82.0})
                expect(table.transmittance(direction(theta).z), Lobes::transmission,
                       [&](auto&) { return direction(theta); });
            expect(table.mean_transmittance(), Lobes::transmission, diffuse(1));
            expect(table.internal_reflectance(), Lobes::reflection, diffuse(-1));
        }
}

TEST(PlasticTable, OfASmoothInterfaceIsFresnels) {
    const PlasticTable& table = plastic_table(0, MicrofacetDistribution::beckmann);
    EXPECT_NEAR(table.internal_reflectance(), internal_diffuse_reflectance(1.5f), 1e-4f);
    EXPECT_NEAR(table.mean_transmittance(), 1 - diffuse_fresnel_reflectance(1.5f), 1e-4f);
    for (double theta : {0.0, 30.0, 60.0, 80.0})
        EXPECT_NEAR(table.transmittance(direction(theta).z), 1 - fresnel_dielectric(direction(theta).z, 1.5f),
                    5e-4f);
}

double furnace_mean(const PlasticBsdf& b, Vec3f wo, std::uint64_t seed) {
    TestStream stream(seed);
    double sum = 0;
    constexpr int n = 50000;
    for (int i = 0; i < n; ++i)
        if (const auto s = b.sample(wo, TransportMode::radiance, stream))
            sum += static_cast<double>(s->weight[0]);
    return sum / n;
}

// Of a white base under an even light: a smooth interface loses nothing, a rough one what its facets shadow: the values
// are those of the quadrature of the closed form over all directions. The mean weights have errors below 2e-3.
TEST(Plastic, WhiteFurnace) {
    for (const MicrofacetDistribution d : plastic_distributions)
        for (float alpha : {0.0f, 0.1f, 0.5f})
            for (double theta : {15.0, 70.0, 110.0}) {
                const PlasticBsdf b = plastic(alpha, d, SampledSpectrum(1), true);
                const Vec3f wo = direction(theta);
                const PlasticTable& t = *b.table;
                const DielectricBsdfOf<MicrofacetNormals> interface { 1.5f, b.normals };
                const double mirrored =
                    alpha == 0 ? static_cast<double>(fresnel_dielectric(std::abs(wo.z), 1.5f))
                               : albedo_of_lobe(
                                     interface, Lobes::reflection,
                                     [&](auto&) { return direction(std::min(theta, 180 - theta)); }, 7)
                                     .mean();
                const float mu = std::abs(wo.z);
                const double diffuse =
                    static_cast<double>(t.transmittance(mu) * t.mean_transmittance() * b.base_albedo[0]);
                const double mean = furnace_mean(b, wo, 5);
                EXPECT_NEAR(mean, mirrored + diffuse, 0.01) << alpha << ' ' << theta;
                EXPECT_LT(mean, 1.01);
                if (alpha == 0) {
                    EXPECT_NEAR(mean, 1, 0.01) << theta;
                }
            }
}

// The closed form by its definition.
TEST(Plastic, IsInterfaceOverBase) {
    const PlasticTable& t = plastic_table(0.3f, MicrofacetDistribution::beckmann);
    const SampledSpectrum rho(0.1f, 0.4f, 0.7f, 1.0f), tint(0.2f, 0.4f, 0.8f, 0.9f);
    const Vec3f wo = direction(40), wi = direction(55, 160);
    TestStream stream(1);
    for (const bool nonlinear : {false, true}) {
        PlasticBsdf b = plastic(0.3f, MicrofacetDistribution::beckmann, rho, nonlinear);
        b.reflected = tint;
        const DielectricBsdfOf<MicrofacetNormals> interface { 1.5f, b.normals };
        const SampledSpectrum mirrored = interface.evaluate(wo, wi, TransportMode::radiance, stream).f;
        const BsdfEvaluation e = b.evaluate(wo, wi, TransportMode::radiance, stream);
        for (int k = 0; k < 4; ++k) {
            const float series = 1 - (nonlinear ? rho[k] : 1) * t.internal_reflectance();
            const float base =
                t.transmittance(wo.z) * t.transmittance(wi.z) / (pi_f * 1.5f * 1.5f) * rho[k] / series;
            EXPECT_NEAR(e.f[k], tint[k] * mirrored[k] + base * wi.z, 1e-6f) << k;
        }
        const BsdfEvaluation below = b.evaluate(-wo, -wi, TransportMode::radiance, stream);
        EXPECT_EQ(below.f, e.f);
        EXPECT_EQ(below.pdf, e.pdf);
        EXPECT_EQ(b.evaluate(wo, -wi, TransportMode::radiance, stream).f, SampledSpectrum(0));
    }
    EXPECT_TRUE(plastic(0, MicrofacetDistribution::ggx, rho).has_specular());
    EXPECT_FALSE(plastic(0.3f, MicrofacetDistribution::beckmann, rho).has_specular());
}

TEST(PlasticTable, TakesAnotherInternalReflectance) {
    const PlasticTable& t = plastic_table(0.1f, MicrofacetDistribution::beckmann);
    const SampledSpectrum rho(0.1f, 0.4f, 0.7f, 1);
    EXPECT_EQ(t.base_albedo(rho, true, t.internal_reflectance()), t.base_albedo(rho, true));
    const SampledSpectrum linear = t.base_albedo(rho, false, 0.5f),
                          nonlinear = t.base_albedo(rho, true, 0.5f);
    for (int k = 0; k < 4; ++k) {
        EXPECT_FLOAT_EQ(linear[k], rho[k] / 0.5f / 2.25f);
        EXPECT_FLOAT_EQ(nonlinear[k], rho[k] / (1 - 0.5f * rho[k]) / 2.25f);
    }
    EXPECT_LT(t.base_albedo(rho, true, 1)[3], 1e5f); // finite
}

// An index of 1 leaves the base.
TEST(Plastic, WithoutAnIndexItIsDiffuse) {
    const PlasticTable table(1, 0.3f, MicrofacetDistribution::beckmann);
    const PlasticBsdf b{&table,
                        {{0.3f, 0.3f}, MicrofacetDistribution::beckmann},
                        table.base_albedo(SampledSpectrum(0.6f), false),
                        SampledSpectrum(1)};
    TestStream stream(1);
    const Vec3f wi = direction(30, 70);
    EXPECT_NEAR(b.evaluate(direction(50), wi, TransportMode::radiance, stream).f[0], 0.6f * wi.z * inv_pi_f,
                1e-5f);
}

} // namespace
} // namespace montelux::testing
