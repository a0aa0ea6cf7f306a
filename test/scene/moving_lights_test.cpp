// Lights that move and are no shapes: they carry their light with them, and the bounds of light trees hold at all
// times; one light among many that move.
#include "test/scene/moving_emitter_testing.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "montelux/scene/light/motion_bounds.h"
#include "montelux/scene/scene_digest.h"

namespace montelux::testing::moving {
namespace {

// Lights that are no shapes, in their own space.
std::vector<emission::Case> lights_that_move() {
    std::vector<emission::Case> cases;
    for (emission::Case& c : emission::all_cases()) {
        const bool movable = std::visit(
            [](const auto& light) {
                if constexpr (requires { light.portal; })
                    if (light.portal) return false;
                return MovableLight<std::decay_t<decltype(light)>>;
            },
            c.scene.lights[0]);
        if (movable) cases.push_back(std::move(c));
    }
    cases.push_back(cases[2]);
    cases.back().name = "wide spot";
    cases.back().scene.lights[0] = SpotLight{1.0f, 3, {1, 2, 3}, normalize(Vec3f{1, -2, 2}), -0.3f, -0.6f};
    return cases;
}

Scene in_motion(Scene scene, const Motion& motion) {
    scene.motions = {motion};
    std::visit(
        [](auto& light) {
            if constexpr (requires { light.motion; }) light.motion = 0;
        },
        scene.lights[0]);
    return scene;
}

TEST(MovingLights, TheirMotionsEnterTheDigest) {
    for (const emission::Case& c : lights_that_move()) {
        Scene scene = c.scene;
        std::vector<ContentDigest> seen;
        for (const Index motion : {no_index, Index{0}, Index{1}}) {
            std::visit(
                [&](auto& light) {
                    if constexpr (requires { light.motion; }) light.motion = motion;
                },
                scene.lights[0]);
            const ContentDigest digest = digest_of(scene).lights;
            EXPECT_EQ(std::count(seen.begin(), seen.end(), digest), 0) << c.name;
            seen.push_back(digest);
        }
    }
}

// What arrives at a point that moves along is the same at any time.
TEST(MovingLights, CarryTheirLightWithThem) {
    const Motion motion(Transform::translate({1, 0, 1}) * Transform::rotate(20, {1, 0.3, 0}),
                        Transform::translate({-1, 2, 0}) * Transform::rotate(70, {1, 2, 0}));
    int kinds = 0;
    for (const emission::Case& c : lights_that_move()) {
        const SceneTables own(c.scene, c.settings);
        const Scene scene = in_motion(c.scene, motion);
        const SceneTables moving(scene, c.settings);
        Draws draws(9);
        int found = 0, differ = 0;
        for (int i = 0; i < 2000; ++i) {
            const float time = times[i % 5];
            const Transform t = motion.at(time); // between keys, not quite a rotation
            const ReferencePoint from{.p = draws.in_cube(6)}, there{.p = t.point(from.p)};
            const Vec2f u = draws.uniform_2d();
            const LightContext at{moving.view(), 0, time}, before{own.view(), 0};
            const auto compare = [&](Vec3f a, Vec3f b, const SampledSpectrum& radiance_a,
                                     const SampledSpectrum& radiance_b, float pdf_a, float pdf_b) {
                ++found;
                differ += !(dot(a, normalize(t.vector(b))) > 1 - 1e-5f) ||
                          !near(radiance_a[0], radiance_b[0], 1e-2f) || !near(pdf_a, pdf_b, 1e-2f);
            };
            if (kind_of(c.scene.lights[0]) != LightKind::infinite) {
                const auto a = sample_li(at, 0, there, u, lambda), b = sample_li(before, 0, from, u, lambda);
                differ += a.has_value() != b.has_value();
                if (a && b) compare(a->wi, b->wi, a->radiance, b->radiance, a->pdf, b->pdf);
                continue;
            }
            // Frames around directions do not turn with them, so the same numbers give another one.
            const auto a = sample_li(at, 0, there, u, lambda);
            if (!a) continue;
            EXPECT_TRUE(near(pdf_li(at, there, {.wi = a->wi}), a->pdf, 1e-3f)) << c.name;
            const Vec3f back = normalize(Vec3f(t.inverse_vector(Vec3d(a->wi))));
            compare(a->wi, back, a->radiance, incident_radiance(before, from, {.wi = back}, lambda), a->pdf,
                    pdf_li(before, from, {.wi = back}));
        }
        EXPECT_GT(found, 30) << c.name;
        EXPECT_LT(differ, 1 + found / 50) << c.name; // at edges
        ++kinds;
    }
    EXPECT_GE(kinds, 10);
}

TEST(MovingLights, StayWithinTheirBounds) {
    const Motion motions[] = {Motion({}, Transform::translate({1, 2, 3})),
                              Motion(Transform::translate({1, 0, 1}) * Transform::rotate(20, {1, 0.3, 0}),
                                     Transform::translate({-1, 2, 0}) * Transform::rotate(70, {1, 2, 0}) *
                                         Transform::scale({1.5, 0.5, 1})),
                              Motion({}, Transform::rotate(170, {0, 0, 1}))};
    int narrow = 0;
    for (const emission::Case& c : lights_that_move())
        for (const Motion& motion : motions) {
            const Scene scene = in_motion(c.scene, motion);
            const SceneTables tables(scene, c.settings);
            const auto bounds = motion_bounds({tables.view(), 0}, 0);
            EXPECT_EQ(bounds.has_value(), kind_of(c.scene.lights[0]) == LightKind::position);
            if (!bounds) continue;
            narrow += bounds->cos_theta_o > 0;
            const double angle =
                std::acos(double(bounds->cos_theta_o)) + std::acos(double(bounds->cos_theta_e));
            Draws draws(11);
            for (int i = 0; i < 2000; ++i) {
                const LightContext context{tables.view(), 0, draws.uniform()};
                const auto s = sample_le(context, 0, draws.uniform_2d(), draws.uniform_2d(), lambda);
                if (!s || is_black(s->radiance)) continue;
                for (int k = 0; k < 3; ++k) {
                    ASSERT_GT(double(s->ray.o[k]), bounds->box.lower[k] - 1e-5) << c.name;
                    ASSERT_LT(double(s->ray.o[k]), bounds->box.upper[k] + 1e-5) << c.name;
                }
                ASSERT_LT(std::acos(std::min(1.0, double(dot(s->ray.d, bounds->axis)))), angle + 1e-3)
                    << c.name;
            }
        }
    EXPECT_GE(narrow, 4);
}

// The mean over the time is an integral in closed form: a point at height h that moves from x = a to b gives
// I / (b - a) [x / (h^2 sqrt(h^2 + x^2))].
TEST(MovingLights, IrradianceOverTheTimeIsThatOfTheClosedForm) {
    const double a = -1, b = 4, h = 1.5;
    Scene scene;
    scene.lights.push_back(PointLight{1.0f, 3, {static_cast<float>(a), 0, static_cast<float>(h)}});
    scene = in_motion(scene, Motion({}, Transform::translate({b - a, 0, 0})));
    const SceneTables tables(scene);
    double mean = 0;
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i) {
        const float time = static_cast<float>((i + 0.5) / n);
        const auto s = sample_li({tables.view(), 0, time}, 0, {}, {}, lambda);
        mean += double(s->radiance[0] * s->wi.z) / n;
    }
    const auto integral = [&](double x) { return x / (h * h * std::sqrt(h * h + x * x)); };
    EXPECT_NEAR(mean, 3 * h * (integral(b) - integral(a)) / (b - a), 1e-5);
}

// Of emitters and lights that all move, those that reach the point at any time can be chosen there.
TEST(MovingLights, EveryOneThatReachesThePointHasAProbability) {
    Scene scene;
    scene.materials.resize(1);
    Emitter::prepare(scene);
    CallMessages messages("a test");
    montelux::SceneBuilder builder(scene, messages);
    Draws draws(13);
    for (int round = 0; round < 6; ++round) {
        for (const Emitter& e : emitters()) {
            const Transform there =
                Transform::translate(Vec3d(draws.in_cube(20))) *
                Transform::rotate(double(draws.uniform(0, 360)), Vec3d(draws.direction()));
            const Emission emission = e.emission();
            builder.add_moving_shape(e.geometry, e.settings(emission, e.flip), there * e.start,
                                     there * e.end);
        }
        for (int i = 0; i < 10; ++i) {
            const Transform start = Transform::translate(Vec3d(draws.in_cube(20))),
                            end = Transform::translate(Vec3d(draws.in_cube(20))) *
                                  Transform::rotate(double(draws.uniform(0, 170)), Vec3d(draws.direction()));
            builder.add_moving_light(SpotLight{1.0f, 9, {1, 0, 0}, draws.direction(), 0.9f, 0.7f}, start,
                                     end);
            builder.add_moving_light(PointLight{1.0f, 9, {1, 0, 0}}, start, end);
        }
    }
    builder.finish();
    for (const LightSampling sampling : {LightSampling::tree, LightSampling::power, LightSampling::uniform}) {
        const SceneTables tables(scene, {}, sampling);
        const LightSampler& sampler = *tables.view().light_sampler;
        const int points = sampling == LightSampling::tree ? 1500 : 200;
        int lit = 0, dark = 0;
        for (int i = 0; i < points; ++i) {
            ReferencePoint from{.p = draws.in_cube(30)};
            if (i % 2 == 0) from.facing = draws.direction();
            const float time = draws.uniform();
            for (Index light = 0; light < scene.lights.size(); ++light) {
                const Index part = static_cast<Index>(i) % part_count({tables.view(), light});
                const auto s =
                    sample_li({tables.view(), light, time}, part, from, draws.uniform_2d(), lambda);
                const bool possible = sampler.probability(from, light, part) > 0;
                dark += !possible;
                if (!s || is_black(s->radiance)) continue;
                if (!(from.facing == Vec3f{}) && dot(s->wi, from.facing) <= 0) continue;
                ++lit;
                ASSERT_TRUE(possible) << "light " << light << ", " << name_of(scene.lights[light]);
            }
        }
        EXPECT_GT(lit, 3 * points);
        EXPECT_GT(dark, sampling == LightSampling::tree ? points / 3 : -1);
    }
}

} // namespace
} // namespace montelux::testing::moving
