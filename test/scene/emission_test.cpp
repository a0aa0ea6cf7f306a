// Emission of lights: positions and directions follow their densities, the mean is the flux, and bounds hold.
// Chi-squared tests at the level of significance.h, means at 5.5 standard errors (4e-8): some 80 tests, below
// 1e-4 for the file.
#include "test/scene/emission_testing.h"
#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/math/frame.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/scene_tables.h"

namespace montelux::emission {
namespace {

// f(case, context, part)
void for_each_part(const auto& f) {
    for (const Case& c : all_cases()) {
        const SceneTables tables(c.scene, c.settings);
        const LightContext context{tables.view(), 0};
        ASSERT_EQ(part_count(context), c.flux.size()) << c.name;
        for (Index part = 0; part < c.flux.size(); ++part) {
            SCOPED_TRACE(c.name + ", part " + std::to_string(part));
            f(c, context, part);
        }
    }
}

Vec2d clamp01(Vec2d p) { return {std::clamp(p.x, 0.0, 1 - 1e-12), std::clamp(p.y, 0.0, 1 - 1e-12)}; }

LightKind kind_of_light(const Case& c) { return kind_of(c.scene.lights[0]); }

TEST(Emission, TheMeanIsTheFlux) {
    for_each_part([](const Case& c, const LightContext& context, Index part) {
        TestUniforms uniforms(part + 3);
        RunningMoments m;
        for (int i = 0; i < 100000; ++i) {
            const Vec2f u = uniforms.next_2f(), v = uniforms.next_2f();
            const auto s = sample_le(context, part, u, v, wavelengths);
            m.add(s ? double(s->radiance[0] * s->cosine / (s->pdf_position * s->pdf_direction)) : 0);
        }
        const double flux = c.flux[part];
        EXPECT_NEAR(m.mean(), flux, 5.5 * m.standard_error() + c.tolerance * flux);
        EXPECT_LT(m.standard_error(), 0.02 * flux);
    });
}

// The estimate that lights are chosen by: exact for spectra that are constant.
TEST(Emission, PowerIsTheFlux) {
    for (const Case& c : all_cases()) {
        if (c.name == "sky" || c.name.find("map") != std::string::npos) continue;
        const SceneTables tables(c.scene, c.settings);
        std::vector<double> powers(c.flux.size());
        light_powers({tables.view(), 0}, powers);
        for (std::size_t i = 0; i < powers.size(); ++i)
            EXPECT_NEAR(powers[i] / c.flux[i], 1, 3e-3) << c.name << ' ' << i;
    }
}

TEST(Emission, DensitiesAreThoseOfTheSamples) {
    for_each_part([](const Case& c, const LightContext& context, Index part) {
        TestUniforms uniforms(7);
        int differing = 0, samples = 0;
        for (int i = 0; i < 5000; ++i) {
            const Vec2f u = uniforms.next_2f(), v = uniforms.next_2f();
            const auto s = sample_le(context, part, u, v, wavelengths);
            if (!s) continue;
            ++samples;
            ASSERT_NEAR(length(s->ray.d), 1, 1e-5);
            if (kind_of_light(c) == LightKind::surface) {
                ASSERT_NEAR(dot(s->n, s->ray.d), s->cosine, 1e-4);
            }
            const EmissionPdf pdf = pdf_le(context, {.part = part, .p = s->ray.o, .n = s->n}, s->ray.d);
            auto differs = [](float a, float b) { return !(std::abs(a / b - 1) < 2e-3f); };
            bool same = true;
            if (kind_of_light(c) == LightKind::position)
                same = pdf.position == 0 && s->pdf_position == 1;
            else
                same = !differs(pdf.position, s->pdf_position);
            if (kind_of_light(c) == LightKind::direction)
                same = same && pdf.direction == 0 && s->pdf_direction == 1;
            else if (s->cosine > 0.01f) // digits of the cosine
                same = same && !differs(pdf.direction, s->pdf_direction);
            differing += !same;
        }
        EXPECT_GT(samples, 2000);
        EXPECT_LE(differing, 10); // at edges of texels and of cones
    });
}

TEST(Emission, PositionsAreUniform) {
    for_each_part([](const Case& c, const LightContext& context, Index part) {
        if (!c.place) return;
        TestUniforms directions(11);
        auto sample = [&](Vec2f u) -> std::optional<Vec2d> {
            // Failures of directions are tested below.
            for (int i = 0; i < 1000; ++i)
                if (const auto s = sample_le(context, part, u, directions.next_2f(), wavelengths))
                    return clamp01(c.place(*s, part));
            return std::nullopt;
        };
        ChiSquaredOptions options;
        options.samples = 50000;
        options.cells_x = options.cells_y = 16;
        const TestResult r = rectangle_chi_squared_test(
            sample, [](Vec2d) { return 1.0; }, {0, 0}, {1, 1}, options);
        EXPECT_TRUE(r.passes(significance)) << r.description;
    });
}

TEST(Emission, DirectionsFollowTheirDensity) {
    for_each_part([](const Case& c, const LightContext& context, Index part) {
        if (kind_of_light(c) == LightKind::direction) return;
        const bool surface = kind_of_light(c) == LightKind::surface;
        TestUniforms positions(13);
        auto sample = [&](Vec2f u) -> std::optional<Vec3f> {
            const auto s = sample_le(context, part, positions.next_2f(), u, wavelengths);
            if (!s) return std::nullopt;
            if (!surface) return s->ray.d;
            // Around the normal that surface_point would report: a light of two sides has half of its
            // directions below.
            const auto* area = std::get_if<AreaLight>(&c.scene.lights[0]);
            Vec3f local = Frame::from_normal(s->n).to_local(s->ray.d);
            if (area->two_sided && u.x >= 0.5f) local = -local;
            return local;
        };
        const Point3f somewhere = context.scene.meshes.empty() ? Point3f{1, 2, 5} : corners[1];
        auto pdf = [&](Vec3f w) {
            return pdf_le(context, {.part = part, .p = somewhere, .n = {0, 0, 1}}, w).direction;
        };
        ChiSquaredOptions options;
        options.samples = 100000;
        options.cells_x = options.cells_y = 32;
        const TestResult r = spherical_chi_squared_test(sample, pdf, options);
        EXPECT_TRUE(r.passes(significance)) << r.description;
    });
}

// Light that comes in from infinity: its samples follow pdf_li, and carry what a ray in their direction meets.
TEST(IncidentLight, OfInfiniteLightsFollowsItsDensity) {
    const ReferencePoint from{.p = Point3f{1, 0, 0}};
    for_each_part([&](const Case& c, const LightContext& context, Index part) {
        if (kind_of_light(c) != LightKind::infinite) return;
        if (c.name == "sun") return; // half of it is hidden: sky_light_test.cpp
        int samples = 0, differing = 0;
        auto sample = [&](Vec2f u) -> std::optional<Vec3f> {
            const auto s = sample_li(context, part, from, u, wavelengths);
            if (!s) return std::nullopt;
            const LightHit hit{.wi = s->wi, .part = part};
            const float pdf = pdf_li(context, from, hit);
            const SampledSpectrum met = incident_radiance(context, from, hit, wavelengths);
            ++samples;
            differing += !(std::abs(pdf / s->pdf - 1) < 2e-3f &&
                           std::abs(met[0] - s->radiance[0]) <= 2e-3f * s->radiance[0]);
            return s->wi;
        };
        auto pdf = [&](Vec3f w) { return pdf_li(context, from, {.wi = w, .part = part}); };
        ChiSquaredOptions options;
        options.samples = 100000;
        options.cells_x = options.cells_y = 32;
        const TestResult r = spherical_chi_squared_test(sample, pdf, options);
        EXPECT_TRUE(r.passes(significance)) << r.description;
        EXPECT_GT(samples, 40000);
        EXPECT_LE(differing, samples / 500); // at edges of texels and of cones
    });
}

TEST(Emission, BoundsHold) {
    for_each_part([](const Case& c, const LightContext& context, Index part) {
        const auto b = light_bounds(context, part);
        const LightKind kind = kind_of_light(c);
        ASSERT_EQ(b.has_value(), kind == LightKind::surface || kind == LightKind::position);
        if (!b) return;
        ASSERT_NEAR(length(b->axis), 1, 1e-5);
        const double limit = std::acos(double(b->cos_theta_o)) + std::acos(double(b->cos_theta_e)) + 1e-3;
        TestUniforms uniforms(17);
        for (int i = 0; i < 5000; ++i) {
            const Vec2f u = uniforms.next_2f(), v = uniforms.next_2f();
            const auto s = sample_le(context, part, u, v, wavelengths);
            if (!s || !(s->radiance[0] > 0)) continue;
            const Vec3d p(s->ray.o), low = b->box.lower - p, high = p - b->box.upper;
            ASSERT_LT(std::max({low.x, low.y, low.z, high.x, high.y, high.z}), 1e-4);
            const double cosine = double(dot(s->ray.d, b->axis));
            ASSERT_LE(std::acos(std::clamp(b->two_sided ? std::abs(cosine) : cosine, -1.0, 1.0)), limit);
        }
    });
}

} // namespace
} // namespace montelux::emission
