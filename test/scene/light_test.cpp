// Sampling of infinite and point lights, and the choice among lights by their power.
// Chi-squared tests at 1e-8 each, sums at 5.5 standard errors (4e-8): below 2e-6 for the file.
#include "test/scene/shape_light_testing.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

using testing::add_light;
using testing::origin;
using testing::wavelengths;

TEST(InfiniteLights, DirectionsFollowTheirDensity) {
    for (int which : {0, 1, 2, 3}) {
        Scene scene;
        if (which == 0) {
            scene.lights.push_back(UniformInfiniteLight{1.0f, 3});
        } else {
            Image map(16, 16, {"R", "G", "B"});
            for (int i = 0; i < 256; ++i)
                for (int c = 0; c < 3; ++c)
                    map.set(i % 16, i / 16, c, i % 5 == 0 ? 0 : 0.1f + static_cast<float>((i * 7) % 11));
            scene.environments.push_back(map);
            scene.lights.push_back(ImageInfiniteLight{
                .environment = 0,
                .scale = 2,
                .world_from_light = which == 1 ? Transform()
                                    : which == 2
                                        ? Transform::rotate(77, {1, -2, 0.5})
                                        : Transform::rotate(20, {1, 2, 3}) * Transform::scale({1, -3, 0.7})});
        }
        SceneTables tables(scene);
        auto sample = [&](Vec2f u) -> std::optional<Vec3f> {
            auto s = sample_li({tables.view(), 0}, 0, origin, u, wavelengths);
            if (!s) return std::nullopt;
            return s->wi;
        };
        auto pdf = [&](Vec3f w) { return pdf_li({tables.view(), 0}, {.p = origin.p}, {.wi = w}); };
        ChiSquaredOptions options;
        options.samples = 20000;
        options.cells_x = options.cells_y = 16;
        TestResult r = spherical_chi_squared_test(sample, pdf, options);
        EXPECT_TRUE(r.passes(1e-8)) << which << ": " << r.description;

        TestUniforms uniforms(9);
        int differing = 0;
        for (int i = 0; i < 5000; ++i) {
            Vec2f u = uniforms.next_2f();
            auto s = sample_li({tables.view(), 0}, 0, origin, u, wavelengths);
            ASSERT_TRUE(s);
            ASSERT_FALSE(s->delta);
            ASSERT_TRUE(std::isinf(s->shadow.t_max));
            // Rounding may send the direction of a point on a texel's edge back into its neighbour.
            bool same =
                std::abs(pdf_li({tables.view(), 0}, {.p = origin.p}, {.wi = s->wi}) / s->pdf - 1) < 1e-3f &&
                std::abs(
                    incident_radiance({tables.view(), 0}, {.p = origin.p}, {.wi = s->wi}, wavelengths)[1] -
                    s->radiance[1]) < 1e-3f * s->radiance[1];
            differing += !same;
        }
        EXPECT_LE(differing, 5) << which;
    }
}

// E[radiance / pdf] is the radiance integrated over the sphere.
TEST(InfiniteLights, MapsIntegrateToTheirMean) {
    Scene scene;
    Image map(8, 8, {"R", "G", "B"});
    double mean = 0;
    for (int i = 0; i < 64; ++i) {
        float v = static_cast<float>((i * 5) % 7);
        mean += double(v) / 64;
        for (int c = 0; c < 3; ++c) map.set(i % 8, i / 8, c, v);
    }
    scene.environments.push_back(map);
    scene.lights.push_back(ImageInfiniteLight{
        .environment = 0, .scale = 2, .world_from_light = Transform::rotate(30, {1, 1, 0})});
    SceneTables tables(scene);
    SampledSpectrum white = RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1}).sample(wavelengths);
    TestUniforms uniforms(3);
    RunningMoments m;
    for (int i = 0; i < 20000; ++i) {
        auto s = sample_li({tables.view(), 0}, 0, origin, uniforms.next_2f(), wavelengths);
        if (s) m.add(double(s->radiance[0] / white[0] / s->pdf));
    }
    // Grey texels: density and radiance rise together, and the estimate has hardly any noise.
    EXPECT_NEAR(m.mean(), 4 * pi * 2 * mean, 5.5 * m.standard_error() + 1e-2);
}

TEST(PointLights, InverseSquareAndFalloff) {
    Scene scene;
    scene.lights.push_back(PointLight{1.0f, 5, {0, 3, 4}});
    const float cos_start = std::cos(0.3f), cos_end = std::cos(0.6f);
    scene.lights.push_back(SpotLight{1.0f, 5, {0, 0, 2}, {0, 0, -1}, cos_start, cos_end});
    scene.lights.push_back(DistantLight{1.0f, 5, normalize(Vec3f{1, 2, 2})});
    SceneTables tables(scene);
    auto at = [&](Index light, Point3f p) {
        return sample_li({tables.view(), light}, 0, {p, {0, 0, 1}, 0}, {0.3f, 0.8f}, wavelengths);
    };
    auto point = at(0, {0, 0, 0});
    ASSERT_TRUE(point && point->delta);
    EXPECT_FLOAT_EQ(point->radiance[0], 5.0f / 25);
    EXPECT_FLOAT_EQ(point->wi.y, 0.6f);
    EXPECT_EQ(point->pdf, 1);
    EXPECT_FALSE(at(0, {0, 3, 4})) << "at the light itself";
    for (float angle : {0.0f, 0.29f, 0.31f, 0.45f, 0.59f, 0.61f}) {
        float x = 2 * std::tan(angle);
        auto s = at(1, {x, 0, 0});
        float c = std::cos(angle), t = std::clamp((c - cos_end) / (cos_start - cos_end), 0.0f, 1.0f);
        float expected = t * t * (3 - 2 * t) * 5 / (4 + x * x);
        ASSERT_EQ(s.has_value(), expected > 0) << angle;
        if (s) {
            EXPECT_NEAR(s->radiance[0], expected, 1e-5) << angle;
        }
    }
    auto distant = at(2, {3, 1, 4});
    ASSERT_TRUE(distant && distant->delta);
    EXPECT_FLOAT_EQ(distant->radiance[0], 5);
    EXPECT_FLOAT_EQ(distant->wi.x, 1.0f / 3);
    EXPECT_TRUE(std::isinf(distant->shadow.t_max));
}

// Lights are chosen in proportion to their power; all spectra are alike here.
TEST(LightTables, ProbabilitiesArePowers) {
    Scene scene;
    add_light(scene, Quadric(Sphere{.world_from_object = {}}));             // area 4 pi, radiance 2
    add_light(scene, Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0});       // area 1/2
    add_light(scene, Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, true); // both sides
    scene.lights.push_back(PointLight{1.0f, 3, {0, 0, 0}});
    scene.lights.push_back(SpotLight{1.0f, 3, {0, 0, 0}, {0, 0, 1}, 0.9f, 0.7f});
    scene.lights.push_back(DistantLight{1.0f, 0.5f, {0, 0, 1}});
    scene.lights.push_back(UniformInfiniteLight{1.0f, 0.25f});
    scene.lights.push_back(PointLight{0.0f, 3, {0, 0, 0}});
    SceneTables tables(scene, {}, LightSampling::power);
    const LightSampler& lights = *tables.view().light_sampler;
    double r = tables.view().light_tables.scene_bounds.radius(), cross_section = pi * r * r;
    EXPECT_GE(r, 1);
    // The smoothstep of a spot has mean 1/2 over the rim.
    const double powers[] = {pi * 4 * pi * 2,
                             pi * 0.5 * 2,
                             pi * 0.5 * 2 * 2,
                             4 * pi * 3,
                             2 * pi * 3 * (0.1 + 0.5 * 0.2),
                             cross_section * 0.5,
                             4 * pi * cross_section * 0.25,
                             0};
    double total = 0, sum = 0;
    for (double p : powers) total += p;
    for (Index i = 0; i < 8; ++i) {
        EXPECT_NEAR(double(lights.probability(origin, i, 0)), powers[i] / total, 1e-5) << i;
        sum += double(lights.probability(origin, i, 0));
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    ASSERT_EQ(tables.view().light_tables.infinite_lights.size(), 1u);
    EXPECT_EQ(tables.view().light_tables.infinite_lights[0], 6u);
    TestUniforms uniforms(2);
    std::vector<double> counts(8), expected;
    for (double p : powers) expected.push_back(p / total * 100000);
    for (int i = 0; i < 100000; ++i) {
        auto chosen = lights.sample(origin, uniforms.next());
        counts[chosen.light] += 1;
        ASSERT_EQ(chosen.probability, lights.probability(origin, chosen.light, chosen.part));
    }
    TestResult result = chi_squared_test(counts, expected);
    EXPECT_TRUE(result.passes(1e-8)) << result.description;
}

// A constant map is a uniform sky.
TEST(LightTables, AMapHasThePowerOfItsMean) {
    Scene scene;
    add_light(scene, Quadric(Sphere{.world_from_object = {}}));
    Image map(4, 4, {"R", "G", "B"});
    std::fill(map.f32().begin(), map.f32().end(), 0.5f);
    scene.environments.push_back(map);
    scene.lights.push_back(ImageInfiniteLight{.environment = 0, .scale = 3, .world_from_light = {}});
    scene.lights.push_back(UniformInfiniteLight{
        add_spectrum(scene, RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1})), 1.5f});
    SceneTables tables(scene);
    EXPECT_NEAR(double(tables.view().light_sampler->probability({}, 1, 0)),
                double(tables.view().light_sampler->probability({}, 2, 0)), 1e-4);
}

} // namespace
} // namespace montelux
