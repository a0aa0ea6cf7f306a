// The closed form of a coated diffuse surface against the random walk through the same layers; the metal below a coat.
#include "test/scene/bsdf_testing.h"
#include <gtest/gtest.h>

#include "montelux/mc/stats/moments.h"
#include "montelux/scene/material/material_model.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux::testing {
namespace {

class Coating : public ::testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Roughness, Coating, ::testing::Values(0.0f, 0.1f, 0.4f));

// False alarms: 24 comparisons at 5 standard errors, 1.4e-5 a roughness.
TEST_P(Coating, ClosedFormIsTheMeanOfTheWalk) {
    TestStream stream(3);
    for (float rho : {0.3f, 0.95f}) {
        CoatedDiffuseBsdf closed = coated_diffuse(GetParam(), rho);
        LayeredBsdf<DiffuseBsdf> walk = layered_diffuse(GetParam(), rho);
        for (double theta_o : {15.0, 60.0, 82.0})
            for (double theta_i : {5.0, 40.0, 75.0, 86.0}) {
                Vec3f wo = direction(theta_o), wi = direction(theta_i, 130);
                RunningMoments m;
                for (int i = 0; i < 25000; ++i)
                    m.add(double(walk.evaluate(wo, wi, TransportMode::radiance, stream).f[0]));
                double f = double(closed.evaluate(wo, wi, TransportMode::radiance, stream).f[0]);
                // The table is within 3e-4 of its integrals.
                EXPECT_NEAR(f, m.mean(), 5 * m.standard_error() + 5e-4 * f)
                    << "rho " << rho << " theta " << theta_o << " " << theta_i;
            }
    }
}

// The first crossing enters, then every second one may lead back to the base.
TEST(CoatingTable, DepthLimitsTheVisitsOfTheBase) {
    const double rho = 0.8;
    for (int max_depth = 1; max_depth <= 8; ++max_depth) {
        const CoatingTable table(1.5f, 0, 0.01f, max_depth);
        const double again = rho * double(table.internal_reflectance());
        EXPECT_GT(again, 0.3);
        double sum = 0, term = rho / (1.5 * 1.5);
        for (int depth = 1; depth <= max_depth; depth += 2, term *= again) sum += term;
        EXPECT_NEAR(table.base_albedo(SampledSpectrum(0.8f))[0], sum, 1e-6) << max_depth;
    }
}

TEST_P(Coating, SampledAlbedoIsTheWalks) {
    TestStream stream(5);
    CoatedDiffuseBsdf closed = coated_diffuse(GetParam(), 0.8f);
    LayeredBsdf<DiffuseBsdf> walk = layered_diffuse(GetParam(), 0.8f);
    for (double theta : {20.0, 70.0, 110.0}) {
        Vec3f wo = direction(theta);
        RunningMoments a, b;
        for (int i = 0; i < 200000; ++i) {
            auto s = closed.sample(wo, TransportMode::radiance, stream);
            auto t = walk.sample(wo, TransportMode::radiance, stream);
            a.add(s ? double(s->weight[0]) : 0);
            b.add(t ? double(t->weight[0]) : 0);
        }
        EXPECT_NEAR(a.mean(), b.mean(), 5 * std::hypot(a.standard_error(), b.standard_error()) + 5e-4);
    }
}

// A layer that absorbs nothing over a white base returns all light, up to the bounces that max_depth cuts
// off.
TEST(CoatingTable, WhiteFurnace) {
    CoatingTable table(1.5f, 0, 0, 200);
    CoatedDiffuseBsdf b{&table, table.base_albedo(SampledSpectrum(1))};
    TestStream stream(9);
    for (double theta : {0.0, 45.0, 80.0}) {
        RunningMoments m;
        for (int i = 0; i < 100000; ++i) {
            auto s = b.sample(direction(theta), TransportMode::radiance, stream);
            m.add(s ? double(s->weight[0]) : 0);
        }
        EXPECT_NEAR(m.mean(), 1, 5 * m.standard_error() + 1e-3);
    }
}

// Fresnel's equations need the complex index of the metal relative to that of the coat.
TEST(CoatedConductor, IndexOfTheMetalIsRelativeToTheCoat) {
    CoatedConductorMaterial material;
    material.metal.eta = {0.75f};
    material.metal.k = {4.5f};
    material.coating.eta = 1.5f;
    const Scene scene;
    const SceneView view(scene);
    const TextureContext context;
    SampledWavelengths lambda = SampledWavelengths::sample_visible(0.4f);
    const auto bsdf = material.bsdf(ParameterEvaluator(view, 0, context, lambda));
    EXPECT_EQ(bsdf.coat.eta, 1.5f);
    for (int i = 0; i < 4; ++i) {
        EXPECT_FLOAT_EQ(bsdf.base.eta[i], 0.5f);
        EXPECT_FLOAT_EQ(bsdf.base.k[i], 3);
    }
    // In air the index is that of the material.
    const ConductorBsdf bare = ParameterEvaluator(view, 0, context, lambda).conductor(material.metal, {}, 1);
    EXPECT_EQ(bare.eta[0], 0.75f);
    EXPECT_EQ(bare.k[0], 4.5f);
}

} // namespace
} // namespace montelux::testing
