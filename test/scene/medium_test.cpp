// Phase functions, grids and majorants of media.
#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/gradient_noise.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/stats/z_test.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

const PhaseFunction phases[] = {HenyeyGreenstein{0}, HenyeyGreenstein{0.8f}, HenyeyGreenstein{-0.4f},
                                Draine{0, 1},        Draine{0.5f, 3},        Draine{-0.7f, 10},
                                Draine{0.002f, 100}, Draine{0.6f, 0},        Draine{0.0005f, 2}};

TEST(PhaseFunction, SamplesFollowThePdf) {
    std::uint64_t seed = 1;
    for (const PhaseFunction& phase : phases)
        for (const Vec3f wo : {Vec3f(0, 0, 1), normalize(Vec3f(1, -2, -0.5f))})
            std::visit(
                [&](const auto& p) {
                    const TestResult r = spherical_chi_squared_test(
                        [&](Vec2f u) { return p.sample(wo, u).wi; }, [&](Vec3f wi) { return p.pdf(wo, wi); },
                        {.samples = 100000, .seed = seed++});
                    EXPECT_TRUE(r.passes(significance)) << p.name << ' ' << p.g << ": " << r.description;
                },
                phase);
}

// By the midpoint rule over the cosine.
TEST(PhaseFunction, IntegratesToOneAndHasItsMeanCosine) {
    for (const PhaseFunction& phase : phases)
        std::visit(
            [&](const auto& p) {
                double total = 0, mean = 0;
                constexpr int n = 20000;
                for (int i = 0; i < n; ++i) {
                    const double mu = -1 + (i + 0.5) * 2 / n;
                    const Vec3f wi(static_cast<float>(std::sqrt(1 - mu * mu)), 0, static_cast<float>(mu));
                    const double value = double(p.pdf({0, 0, -1}, wi)) * 2 * pi * 2 / n;
                    total += value;
                    mean += mu * value;
                }
                EXPECT_NEAR(total, 1, 2e-5) << p.name << ' ' << p.g;
                EXPECT_NEAR(mean, double(p.mean_cosine()), 2e-5) << p.name << ' ' << p.g;
            },
            phase);
}

TEST(PhaseFunction, SamplesReportTheirPdf) {
    TestUniforms uniforms(5);
    for (const PhaseFunction& phase : phases)
        std::visit(
            [&](const auto& p) {
                for (int i = 0; i < 1000; ++i) {
                    const PhaseSample s = p.sample({0, 0.6f, 0.8f}, uniforms.next_2f());
                    EXPECT_NEAR(length(s.wi), 1, 1e-5);
                    EXPECT_EQ(s.pdf, p.pdf(Vec3f(0, 0.6f, 0.8f), s.wi));
                }
            },
            phase);
}

TEST(MediumGrid, InterpolatesBetweenSamplesAndFallsToZeroBeyond) {
    ScalarGrid g;
    g.size = {2, 1, 3};
    g.values = {1, 2, 3, 4, 5, 6};
    EXPECT_FLOAT_EQ(g({0.25f, 0.5f, 1.0f / 6}), 1);
    EXPECT_FLOAT_EQ(g({0.75f, 0.5f, 0.5f}), 4);
    EXPECT_FLOAT_EQ(g({0.5f, 0.5f, 1.0f / 3}), 2.5f);
    EXPECT_FLOAT_EQ(g({0, 0.5f, 1.0f / 6}), 0.5f); // half-way to a sample outside
    EXPECT_EQ(g({-1, 0.5f, 0.5f}), 0);
    EXPECT_EQ(g({1e30f, 0.5f, 0.5f}), 0);
}

// Every segment bounds the density on it, the segments join, and together they are the part within the cube.
TEST(MajorantWalk, BoundsTheDensityAlongRays) {
    Scene scene;
    ScalarGrid& g = scene.scalar_grids.emplace_back();
    g.size = {37, 5, 20};
    TestUniforms uniforms(3);
    for (std::size_t i = 0; i < g.count(); ++i) g.values.push_back(std::pow(uniforms.next_float(), 8.0f));
    GridMedium medium;
    medium.box.p0 = {-2, 1, 0};
    medium.box.p1 = {1, 2, 5};
    medium.box.world_from_medium = Transform::rotate(30, {1, 2, 3}) * Transform::scale({1, 3, 0.5});
    medium.density = 0;
    medium.sigma_a = 0.25f;
    medium.sigma_s = 0.75f;
    scene.media.push_back(medium);
    SceneTables tables(scene);
    const auto local = medium.at(tables.view(), 0, SampledWavelengths::sample_visible(0.5f));
    double passed = 0;
    for (int i = 0; i < 2000; ++i) {
        const Point3f target = medium.box.world_from_medium.point(
            Point3f(-2 + 3 * uniforms.next_float(), 1 + uniforms.next_float(), 5 * uniforms.next_float()));
        Vec3f d = normalize(Vec3f(uniforms.next_float(), uniforms.next_float(), uniforms.next_float()) -
                            Vec3f(0.5f, 0.5f, 0.5f));
        if (i % 5 == 0) // along an axis of the grid
            d = normalize(medium.box.world_from_medium.vector(Vec3f(i % 3 == 0, i % 3 == 1, i % 3 == 2)));
        const Ray ray{target - d * (10 * uniforms.next_float()), d};
        MajorantWalk walk = local.majorants(ray);
        MajorantSegment s;
        float end = -1, begin = 0;
        while (walk.next(s)) {
            EXPECT_LE(s.t0, s.t1);
            if (end >= 0)
                EXPECT_EQ(s.t0, end);
            else
                begin = s.t0;
            end = s.t1;
            for (int k = 0; k < 8; ++k) {
                const float t = s.t0 + (s.t1 - s.t0) * uniforms.next_float();
                const MediumPoint p = local.coefficients(ray.o + ray.d * t);
                EXPECT_LE((p.sigma_a + p.sigma_s)[0], s.majorant[0] * 1.0001f + 1e-6f);
            }
        }
        if (end < 0) continue;
        const AffineMap& unit = tables.view().medium_tables[0].unit_from_world;
        const CubeInterval inside = intersect_unit_cube(unit.ray(ray));
        EXPECT_EQ(begin, inside.t0);
        EXPECT_EQ(end, inside.t1);
        passed += double(end - begin);
    }
    EXPECT_GT(passed, 1000);
}

// A coefficient without a grid is 1 everywhere; both are scaled.
TEST(MajorantWalk, BoundsCoefficientsWithAndWithoutColors) {
    Scene scene;
    ColorGrid& g = scene.color_grids.emplace_back();
    g.size = {5, 3, 2};
    TestUniforms uniforms(4);
    for (std::size_t i = 0; i < g.count(); ++i)
        g.values.push_back(RgbUnboundedSpectrum(
            RgbColorSpace::srgb(), {uniforms.next_float(), uniforms.next_float(), uniforms.next_float()}));
    for (const Index absorption : {no_index, Index{0}})
        for (const Index scattering : {no_index, Index{0}}) {
            scene.media = {
                RgbGridMedium{.box = {}, .sigma_a = absorption, .sigma_s = scattering, .scale = 3}};
            const SceneTables tables(scene);
            const auto local = std::get<RgbGridMedium>(scene.media[0])
                                   .at(tables.view(), 0, SampledWavelengths::sample_visible(0.5f));
            int passed = 0;
            for (int i = 0; i < 100; ++i) {
                const Ray ray{{-1, uniforms.next_float(), uniforms.next_float()}, {1, 0, 0}};
                MajorantWalk walk = local.majorants(ray);
                MajorantSegment s;
                while (walk.next(s))
                    for (int k = 0; k < 4; ++k, ++passed) {
                        const float t = s.t0 + (s.t1 - s.t0) * uniforms.next_float();
                        const MediumPoint p = local.coefficients(ray.o + ray.d * t);
                        for (int c = 0; c < 4; ++c)
                            ASSERT_LE((p.sigma_a + p.sigma_s)[c], s.majorant[c] * 1.0001f + 1e-6f)
                                << absorption << ' ' << scattering;
                        if (absorption == no_index && scattering == no_index) {
                            ASSERT_EQ(s.majorant[0], 6);
                        }
                    }
            }
            EXPECT_GE(passed, 400);
        }
}

// The offset is in the unit of the grid. Nothing glows at 100 kelvins or below.
TEST(GridMedium, GlowsAtItsTemperature) {
    Scene scene;
    for (const float value : {0.8f, 12.0f}) {
        ScalarGrid& g = scene.scalar_grids.emplace_back();
        g.size = {1, 1, 1};
        g.values = {value};
    }
    const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.5f);
    const auto emission = [&](float offset) {
        GridMedium medium;
        medium.density = 0;
        medium.temperature = 1;
        medium.temperature_offset = offset;
        medium.temperature_scale = 300;
        medium.sigma_a = 0.5f;
        medium.le_scale = 4;
        scene.media = {medium};
        const SceneTables tables(scene);
        return medium.at(tables.view(), 0, lambda).coefficients({0.5f, 0.5f, 0.5f}).emission;
    };
    const SampledSpectrum glow = BlackbodySpectrum(3000).sample(lambda);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(emission(2)[c] / (0.5f * 0.8f * 4 * glow[c]), 1, 1e-4);
    EXPECT_TRUE(is_black(emission(11.75f)));
    EXPECT_FALSE(is_black(emission(10)));
}

TEST(GradientNoise, IsZeroAtIntegersAndSmooth) {
    EXPECT_EQ(gradient_noise({3, -7, 250}), 0);
    EXPECT_FLOAT_EQ(gradient_noise({0.25f, 0.5f, 0.75f}), gradient_noise({256.25f, 0.5f, -255.25f}));
    // Perlin 2002, his reference program's noise(3.14, 42, 7).
    EXPECT_NEAR(gradient_noise({3.14f, 42, 7}), 0.13691995878400012, 1e-6);
    RunningMoments values;
    TestUniforms uniforms(9);
    for (int i = 0; i < 20000; ++i) {
        const Point3f p(256 * uniforms.next_float(), 256 * uniforms.next_float(),
                        256 * uniforms.next_float());
        values.add(double(gradient_noise(p)));
        EXPECT_NEAR(gradient_noise(p), gradient_noise(p + Vec3f(1e-3f, 1e-3f, -1e-3f)), 1e-2);
    }
    EXPECT_TRUE(unbiasedness_test(values, 0).passes(significance));
    EXPECT_GT(values.standard_deviation(), 0.15);
}

TEST(CloudMedium, IsDenseBelowAndEmptyAbove) {
    const CloudMedium cloud;
    EXPECT_EQ(cloud.density_at({0.3f, 0, 0.7f}), 1);
    EXPECT_EQ(cloud.density_at({0.3f, 1, 0.7f}), 0);
    int some = 0;
    for (int i = 0; i < 1000; ++i) {
        const float d = cloud.density_at({0.013f * static_cast<float>(i), 0.7f, 0.2f});
        EXPECT_GE(d, 0);
        EXPECT_LE(d, 1);
        some += d > 0 && d < 1;
    }
    EXPECT_GT(some, 100);
}

} // namespace
} // namespace montelux
