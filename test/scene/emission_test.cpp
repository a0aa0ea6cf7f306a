// Emission of lights: positions and directions follow their densities, the mean is the flux, and bounds hold.
#include "montelux/scene/scene_tables.h"
// Chi-squared tests at the level of significance.h, means at 5.5 standard errors (4e-8): some 80 tests, below
#include "montelux/scene/scene_tables.h"
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
#include "montelux/scene/scene_tables.h"
namespace {
#include "montelux/scene/scene_tables.h"
// f(case, context, part)
#include "montelux/scene/scene_tables.h"
void for_each_part(const auto& f) {
#include "montelux/scene/scene_tables.h"
    for (const Case& c : all_cases()) {
#include "montelux/scene/scene_tables.h"
        const SceneTables tables(c.scene, c.settings);
#include "montelux/scene/scene_tables.h"
        const LightContext context{tables.view(), 0};
#include "montelux/scene/scene_tables.h"
        ASSERT_EQ(part_count(context), c.flux.size()) << c.name;
#include "montelux/scene/scene_tables.h"
        for (Index part = 0; part < c.flux.size(); ++part) {
#include "montelux/scene/scene_tables.h"
            SCOPED_TRACE(c.name + ", part " + std::to_string(part));
#include "montelux/scene/scene_tables.h"
            f(c, context, part);
#include "montelux/scene/scene_tables.h"
        }
#include "montelux/scene/scene_tables.h"
    }
#include "montelux/scene/scene_tables.h"
}
#include "montelux/scene/scene_tables.h"
Vec2d clamp01(Vec2d p) { return {std::clamp(p.x, 0.0, 1 - 1e-12), std::clamp(p.y, 0.0, 1 - 1e-12)}; }
#include "montelux/scene/scene_tables.h"
LightKind kind_of_light(const Case& c) { return kind_of(c.scene.lights[0]); }
#include "montelux/scene/scene_tables.h"
TEST(Emission, TheMeanIsTheFlux) {
#include "montelux/scene/scene_tables.h"
    for_each_part([](const Case& c, const LightContext& context, Index part) {
#include "montelux/scene/scene_tables.h"
        TestUniforms uniforms(part + 3);
#include "montelux/scene/scene_tables.h"
        RunningMoments m;
#include "montelux/scene/scene_tables.h"
        for (int i = 0; i < 100000; ++i) {
#include "montelux/scene/scene_tables.h"
            const Vec2f u = uniforms.next_2f(), v = uniforms.next_2f();
#include "montelux/scene/scene_tables.h"
            const auto s = sample_le(context, part, u, v, wavelengths);
#include "montelux/scene/scene_tables.h"
            m.add(s ? double(s->radiance[0] * s->cosine / (s->pdf_position * s->pdf_direction)) : 0);
#include "montelux/scene/scene_tables.h"
        }
#include "montelux/scene/scene_tables.h"
        const double flux = c.flux[part];
#include "montelux/scene/scene_tables.h"
        EXPECT_NEAR(m.mean(), flux, 5.5 * m.standard_error() + c.tolerance * flux);
#include "montelux/scene/scene_tables.h"
        EXPECT_LT(m.standard_error(), 0.02 * flux);
#include "montelux/scene/scene_tables.h"
    });
#include "montelux/scene/scene_tables.h"
}
#include "montelux/scene/scene_tables.h"
// The estimate that lights are chosen by: exact for spectra that are constant.
#include "montelux/scene/scene_tables.h"
TEST(Emission, PowerIsTheFlux) {
#include "montelux/scene/scene_tables.h"
    for (const Case& c : all_cases()) {
#include "montelux/scene/scene_tables.h"
        if (c.name == "sky" || c.name.find("map") != std::string::npos) continue;
#include "montelux/scene/scene_tables.h"
        const SceneTables tables(c.scene, c.settings);
#include "montelux/scene/scene_tables.h"
        std::vector<double> powers(c.flux.size());
#include "montelux/scene/scene_tables.h"
        light_powers({tables.view(), 0}, powers);
#include "montelux/scene/scene_tables.h"
        for (std::size_t i = 0; i < powers.size(); ++i)
#include "montelux/scene/scene_tables.h"
            EXPECT_NEAR(powers[i] / c.flux[i], 1, 3e-3) << c.name << ' ' << i;
#include "montelux/scene/scene_tables.h"
    }
#include "montelux/scene/scene_tables.h"
}
#include "montelux/scene/scene_tables.h"
TEST(Emission, DensitiesAreThoseOfTheSamples) {
#include "montelux/scene/scene_tables.h"
    for_each_part([](const Case& c, const LightContext& context, Index part) {
#include "montelux/scene/scene_tables.h"
        TestUniforms uniforms(7);
#include "montelux/scene/scene_tables.h"
        int differing = 0, samples = 0;
#include "montelux/scene/scene_tables.h"
        for (int i = 0; i < 5000; ++i) {
#include "montelux/scene/scene_tables.h"
            const Vec2f u = uniforms.next_2f(), v = uniforms.next_2f();
#include "montelux/scene/scene_tables.h"
            const auto s = sample_le(context, part, u, v, wavelengths);
#include "montelux/scene/scene_tables.h"
            if (!s) continue;
#include "montelux/scene/scene_tables.h"
            ++samples;
#include "montelux/scene/scene_tables.h"
            ASSERT_NEAR(length(s->ray.d), 1, 1e-5);
#include "montelux/scene/scene_tables.h"
            if (kind_of_light(c) == LightKind::surface) {
#include "montelux/scene/scene_tables.h"
                ASSERT_NEAR(dot(s->n, s->ray.d), s->cosine, 1e-4);
#include "montelux/scene/scene_tables.h"
            }
#include "montelux/scene/scene_tables.h"
            const EmissionPdf pdf = pdf_le(context, {.part = part, .p = s->ray.o, .n = s->n}, s->ray.d);
#include "montelux/scene/scene_tables.h"
            auto differs = [](float a, float b) { return !(std::abs(a / b - 1) < 2e-3f); };
#include "montelux/scene/scene_tables.h"
            bool same = true;
#include "montelux/scene/scene_tables.h"
            if (kind_of_light(c) == LightKind::position)
#include "montelux/scene/scene_tables.h"
                same = pdf.position == 0 && s->pdf_position == 1;
#include "montelux/scene/scene_tables.h"
            else
#include "montelux/scene/scene_tables.h"
                same = !differs(pdf.position, s->pdf_position);
#include "montelux/scene/scene_tables.h"
            if (kind_of_light(c) == LightKind::direction)
#include "montelux/scene/scene_tables.h"
                same = same && pdf.direction == 0 && s->pdf_direction == 1;
#include "montelux/scene/scene_tables.h"
            else if (s->cosine > 0.01f) // digits of the cosine
#include "montelux/scene/scene_tables.h"
                same = same && !differs(pdf.direction, s->pdf_direction);
#include "montelux/scene/scene_tables.h"
            differing += !same;
#include "montelux/scene/scene_tables.h"
        }
#include "montelux/scene/scene_tables.h"
        EXPECT_GT(samples, 2000);
#include "montelux/scene/scene_tables.h"
        EXPECT_LE(differing, 10); // at edges of texels and of cones
#include "montelux/scene/scene_tables.h"
    });
#include "montelux/scene/scene_tables.h"
}
#include "montelux/scene/scene_tables.h"
TEST(Emission, PositionsAreUniform) {
#include "montelux/scene/scene_tables.h"
    for_each_part([](const Case& c, const LightContext& context, Index part) {
#include "montelux/scene/scene_tables.h"
        if (!c.place) return;
#include "montelux/scene/scene_tables.h"
        TestUniforms directions(11);
#include "montelux/scene/scene_tables.h"
        auto sample = [&](Vec2f u) -> std::optional<Vec2d> {
#include "montelux/scene/scene_tables.h"
        // Failures of directions are tested below.
#include "montelux/scene/scene_tables.h"
            for (int i = 0; i < 1000; ++i)
#include "montelux/scene/scene_tables.h"
                if (const auto s = sample_le(context, part, u, directions.next_2f(), wavelengths))
#include "montelux/scene/scene_tables.h"
                    return clamp01(c.place(*s, part));
#include "montelux/scene/scene_tables.h"
            return std::nullopt;
#include "montelux/scene/scene_tables.h"
        };
#include "montelux/scene/scene_tables.h"
        ChiSquaredOptions options;
#include "montelux/scene/scene_tables.h"
        options.samples = 50000;
#include "montelux/scene/scene_tables.h"
        options.cells_x = options.cells_y = 16;
#include "montelux/scene/scene_tables.h"
        const TestResult r = rectangle_chi_squared_test(
#include "montelux/scene/scene_tables.h"
            sample, [](Vec2d) { return 1.0; }, {0, 0}, {1, 1}, options);
#include "montelux/scene/scene_tables.h"
        EXPECT_TRUE(r.passes(significance)) << r.description;
#include "montelux/scene/scene_tables.h"
    });
#include "montelux/scene/scene_tables.h"
}
#include "montelux/scene/scene_tables.h"
TEST(Emission, DirectionsFollowTheirDensity) {
#include "montelux/scene/scene_tables.h"
    for_each_part([](const Case& c, const LightContext& context, Index part) {
#include "montelux/scene/scene_tables.h"
        if (kind_of_light(c) == LightKind::direction) return;
#include "montelux/scene/scene_tables.h"
        const bool surface = kind_of_light(c) == LightKind::surface;
#include "montelux/scene/scene_tables.h"
        TestUniforms positions(13);
#include "montelux/scene/scene_tables.h"
        auto sample = [&](Vec2f u) -> std::optional<Vec3f> {
#include "montelux/scene/scene_tables.h"
            const auto s = sample_le(context, part, positions.next_2f(), u, wavelengths);
#include "montelux/scene/scene_tables.h"
            if (!s) return std::nullopt;
#include "montelux/scene/scene_tables.h"
            if (!surface) return s->ray.d;
#include "montelux/scene/scene_tables.h"
                // Around the normal that surface_point would report: a light of two sides has half of its
#include "montelux/scene/scene_tables.h"
                // directions below.
#include "montelux/scene/scene_tables.h"
            const auto* area = std::get_if<AreaLight>(&c.scene.lights[0]);
#include "montelux/scene/scene_tables.h"
            Vec3f local = Frame::from_normal(s->n).to_local(s->ray.d);
#include "montelux/scene/scene_tables.h"
            if (area->two_sided && u.x >= 0.5f) local = -local;
#include "montelux/scene/scene_tables.h"
            return local;
#include "montelux/scene/scene_tables.h"
        };
#include "montelux/scene/scene_tables.h"
        const Point3f somewhere = context.scene.meshes.empty() ? Point3f{1, 2, 5} : corners[1];
#include "montelux/scene/scene_tables.h"
        auto pdf = [&](Vec3f w) {
#include "montelux/scene/scene_tables.h"
            return pdf_le(context, {.part = part, .p = somewhere, .n = {0, 0, 1}}, w).direction;
#include "montelux/scene/scene_tables.h"
        };
#include "montelux/scene/scene_tables.h"
        ChiSquaredOptions options;
#include "montelux/scene/scene_tables.h"
        options.samples = 100000;
#include "montelux/scene/scene_tables.h"
        options.cells_x = options.cells_y = 32;
#include "montelux/scene/scene_tables.h"
        const TestResult r = spherical_chi_squared_test(sample, pdf, options);
#include "montelux/scene/scene_tables.h"
        EXPECT_TRUE(r.passes(significance)) << r.description;
#include "montelux/scene/scene_tables.h"
    });
#include "montelux/scene/scene_tables.h"
}
#include "montelux/scene/scene_tables.h"
TEST(Emission, BoundsHold) {
#include "montelux/scene/scene_tables.h"
    for_each_part([](const Case& c, const LightContext& context, Index part) {
#include "montelux/scene/scene_tables.h"
        const auto b = light_bounds(context, part);
#include "montelux/scene/scene_tables.h"
        const LightKind kind = kind_of_light(c);
#include "montelux/scene/scene_tables.h"
        ASSERT_EQ(b.has_value(), kind == LightKind::surface || kind == LightKind::position);
#include "montelux/scene/scene_tables.h"
        if (!b) return;
#include "montelux/scene/scene_tables.h"
        ASSERT_NEAR(length(b->axis), 1, 1e-5);
#include "montelux/scene/scene_tables.h"
        const double limit = std::acos(double(b->cos_theta_o)) + std::acos(double(b->cos_theta_e)) + 1e-3;
#include "montelux/scene/scene_tables.h"
        TestUniforms uniforms(17);
#include "montelux/scene/scene_tables.h"
        for (int i = 0; i < 5000; ++i) {
#include "montelux/scene/scene_tables.h"
            const Vec2f u = uniforms.next_2f(), v = uniforms.next_2f();
#include "montelux/scene/scene_tables.h"
            const auto s = sample_le(context, part, u, v, wavelengths);
#include "montelux/scene/scene_tables.h"
            if (!s || !(s->radiance[0] > 0)) continue;
#include "montelux/scene/scene_tables.h"
            const Vec3d p(s->ray.o), low = b->box.lower - p, high = p - b->box.upper;
#include "montelux/scene/scene_tables.h"
            ASSERT_LT(std::max({low.x, low.y, low.z, high.x, high.y, high.z}), 1e-4);
#include "montelux/scene/scene_tables.h"
            const double cosine = double(dot(s->ray.d, b->axis));
#include "montelux/scene/scene_tables.h"
            ASSERT_LE(std::acos(std::clamp(b->two_sided ? std::abs(cosine) : cosine, -1.0, 1.0)), limit);
#include "montelux/scene/scene_tables.h"
        }
#include "montelux/scene/scene_tables.h"
    });
#include "montelux/scene/scene_tables.h"
}
#include "montelux/scene/scene_tables.h"
} // namespace
#include "montelux/scene/scene_tables.h"
} // namespace montelux::emission
#include "montelux/scene/scene_tables.h"
