// Values of BSDFs that are those of Mitsuba: what Mitsuba 3.9.1 (scalar_rgb) evaluates for the same parameters.
#include "test/scene/bsdf_testing.h"
#include "test/scene/principled_testing.h"
#include <array>
#include <gtest/gtest.h>

namespace montelux::testing {
namespace {

using Values = std::array<float, 6>;

// For six pairs of directions; 0 where only one side of Mitsuba's plugin scatters.
void expect_values(const Bsdf& bsdf, const Values& expected, const char* what) {
    const Vec3f pairs[][2] = {
        {direction(40, 20), direction(55, 160)},   {direction(70, 0), direction(75, 185)},
        {direction(30, 10), direction(20, 100)},   {direction(35, 20), direction(130, 210)},
        {direction(140, 20), direction(120, 200)}, {direction(150, 30), direction(40, 200)}};
    TestStream stream(1);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const float f = evaluate(bsdf, pairs[i][0], pairs[i][1], stream).f[0];
        EXPECT_NEAR(f, expected[i], 2e-5f * expected[i] + 1e-7f) << what << ", pair " << i;
    }
}

Bsdf made(const auto& material) {
    SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);
    SceneView view;
    view.spectra = palette();
    const TextureContext context{};
    return material.bsdf(ParameterEvaluator(view, 0, context, lambda));
}

TEST(MitsubaValues, RoughConductor) {
    ConductorMaterial m{.metal = {.eta = {0.2f}, .k = {3.9f}}, .roughness = {{0.3f}, {0.2f}, false}};
    m.distribution = MicrofacetDistribution::beckmann;
    // The fifth pair is below the surface, where Mitsuba's is black.
    expect_values(made(m), {0.0568377f, 2.19301f, 0.240558f, 0, 1.17566f, 0}, "Beckmann");
    m.distribution = MicrofacetDistribution::ggx_separable;
    expect_values(made(m), {0.0958957f, 1.16966f, 0.196785f, 0, 0.833827f, 0}, "GGX");
}

TEST(MitsubaValues, RoughDielectric) {
    DielectricMaterial m{.eta = 1.5f, .roughness = {{0.3f}, {0.3f}, false}};
    m.distribution = MicrofacetDistribution::beckmann;
    expect_values(made(m), {0.0135599f, 0.41636f, 0.0145336f, 0, 0.868675f, 9.58637f}, "Beckmann");
    m.distribution = MicrofacetDistribution::ggx_separable;
    expect_values(made(m), {0.00964873f, 0.251959f, 0.00991726f, 0.0607287f, 0.627625f, 6.36796f}, "GGX");
}

TEST(MitsubaValues, Principled) {
    expect_values(made(DisneyMaterial{.base_color = {0.36f}}), {0.0743977f, 0.36436f, 0.116933f, 0, 0, 0},
                  "default");
    const DisneyMaterial lacquer{.base_color = {0.36f},
                                 .metallic = {0.3f},
                                 .roughness = {0.4f},
                                 .anisotropic = {0.6f},
                                 .eta = 2 / (1 - std::sqrt(0.08f * 0.7f)) - 1, // specular 0.7
                                 .sheen = {0.5f},
                                 .clearcoat = {0.8f},
                                 .clearcoat_gloss = {0.3f}};
    expect_values(made(lacquer), {0.0529857f, 0.35432f, 0.0940701f, 0, 0, 0}, "lacquer");
    const DisneyMaterial glass{.base_color = {0.36f},
                               .metallic = {0.2f},
                               .eta = 1.4f,
                               .flatness = {0.7f},
                               .specular_transmission = {0.6f}};
    expect_values(made(glass), {0.0377407f, 0.410094f, 0.0487602f, 0.0137041f, 0.358114f, 2.235f}, "glass");
    // Grey has no tint.
    DisneyMaterial tinted = lacquer;
    tinted.sheen_tint = {1};
    expect_values(made(tinted), {0.0529857f, 0.35432f, 0.0940701f, 0, 0, 0}, "tinted sheen");
}

TEST(MitsubaValues, PrincipledThin) {
    const DisneyThinMaterial m{.base_color = {0.36f},
                               .anisotropic = {0.3f},
                               .eta = {1.4f},
                               .sheen = {0.5f},
                               .flatness = {0.4f},
                               .specular_transmission = {0.6f},
                               .diffuse_transmission = {0.4f}}; // Mitsuba's diff_trans is 0.8
    expect_values(made(m), {0.0179583f, 0.157218f, 0.0263103f, 0.125535f, 0.0357154f, 0.57828f}, "thin");
}

// Mitsuba's sum for the internal reflectance R of rough plastic has 64 points of equal weight from 0 to 1, which gives
// 63/64 R + R(1)/64 for the reflectance R(1) along the normal.
TEST(MitsubaValues, RoughPlastic) {
    const float eta = 1.49f / 1.000277f, f0 = (eta - 1) / (eta + 1);
    const auto expect = [&](float alpha, MicrofacetDistribution d, float first, float second,
                            float tolerance) {
        const PlasticTable t(eta, alpha, d);
        const float r = alpha == 0 ? 0 : (63 * t.internal_reflectance() + f0 * f0) / 64;
        const PlasticBsdf b{
            &t, {{alpha, alpha}, d}, t.base_albedo(SampledSpectrum(0.5f), false, r), SampledSpectrum(1)};
        TestStream stream(1);
        const auto value = [&](Vec3f wo, Vec3f wi) {
            return b.evaluate(wo, wi, TransportMode::radiance, stream).f[0];
        };
        EXPECT_NEAR(value(direction(30), direction(40, 120)), first, tolerance * first) << alpha;
        EXPECT_NEAR(value(direction(75), direction(60, 180)), second, tolerance * second) << alpha;
    };
    // Of smooth plastic it uses fits for R.
    expect(0, MicrofacetDistribution::ggx, 0.123074f, 0.0598515f, 2e-3f);
    const MicrofacetDistribution beckmann = MicrofacetDistribution::beckmann;
    expect(0.1f, beckmann, 0.118399f, 0.849908f, 1e-3f);
    expect(0.3f, beckmann, 0.117476f, 0.450473f, 1e-3f);
    expect(0.6f, beckmann, 0.0889462f, 0.13739f, 1e-3f);
    expect(0.1f, MicrofacetDistribution::ggx_separable, 0.112832f, 0.631503f, 1e-3f);
    expect(0.3f, MicrofacetDistribution::ggx_separable, 0.0910974f, 0.306385f, 1e-3f);
    expect(0.6f, MicrofacetDistribution::ggx_separable, 0.0649612f, 0.0797083f, 1e-3f);
}

// A tint keeps the hue and has luminance 1.
TEST(DisneyMaterial, TintsHaveUnitLuminance) {
    SceneView view;
    view.spectra = palette();
    const TextureContext context{};
    double y = 0;
    constexpr int n = 200;
    for (int i = 0; i < n; ++i) {
        SampledWavelengths lambda = SampledWavelengths::sample_visible((static_cast<float>(i) + 0.5f) / n);
        const ParameterEvaluator at(view, 0, context, lambda);
        const SampledSpectrum tint = at.tint({red_paint}, 1);
        for (int k = 0; k < 4; ++k) {
            const auto nm = static_cast<std::size_t>(lambda.lambda[k] - lambda_min + 0.5f);
            y += static_cast<double>(tint[k] * cie_y[nm] / lambda.pdf[k]) / cie_y_integral / (4 * n);
        }
        EXPECT_EQ(at.tint({red_paint}, 0), SampledSpectrum(1));
        EXPECT_EQ(at.tint({0.0f}, 1), SampledSpectrum(1));
        const SampledSpectrum half = at.tint({red_paint}, 0.5f);
        EXPECT_NEAR(half[1], 0.5f + 0.5f * tint[1], 1e-6f);
    }
    EXPECT_NEAR(y, 1, 0.02); // eight wavelengths
}

} // namespace
} // namespace montelux::testing
