// Lights that move: at any time they are the still light that stands there, hits and samples have one density, and
// the bounds of light trees hold at all times.
#include "test/accel/accel_testing.h"
#include "test/scene/emission_testing.h"
#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

#include "montelux/scene/light/emissive_shape.h"
#include "montelux/scene/light/motion_bounds.h"
#include "montelux/scene/scene_digest.h"

namespace montelux::testing {
namespace {

constexpr float times[] = {0, 0.21f, 0.5f, 0.77f, 1};
const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);

// A shape of radiance 2 on the side of its normal.
struct Emitter {
    std::string name;
    Geometry geometry; // in its own space; a mesh may deform
    Transform start{}, end{};
    bool two_sided = false;
    float power = 0;
    bool flip = false;
    bool picture = false, holes = false; // a picture of 8 x 8 texels; a checkerboard of 6 x 6 fields

    ShapeSettings settings(const Emission& emission, bool flipped) const {
        return {.material = 0,
                .alpha = holes ? FloatParameter{1, 0} : FloatParameter{1},
                .flip_normal = flipped,
                .emission = &emission};
    }
    Emission emission() const {
        return {.spectrum = 1.0f,
                .scale = 2,
                .two_sided = two_sided,
                .power = power,
                .picture = picture ? 0 : no_index};
    }
    Scene moving() const {
        return made([&](montelux::SceneBuilder& b, const Emission& e) {
            b.add_moving_shape(geometry, settings(e, flip), start, end);
        });
    }
    // Directly in the world, as it is at that time.
    Scene still(float time) const {
        const Transform t = start == end ? start : Motion(start, end).at(time);
        return made([&](montelux::SceneBuilder& b, const Emission& e) {
            Geometry there = geometry;
            bool flipped = flip;
            if (auto* mesh = std::get_if<TriangleMesh>(&there)) {
                for (Index v = 0; v < mesh->positions.size(); ++v) {
                    mesh->positions[v] = mesh->position(v, time);
                    if (!mesh->normals.empty()) mesh->normals[v] = mesh->normal(v, time);
                }
                mesh->end_positions.clear();
                mesh->end_normals.clear();
                transform_mesh(*mesh, t);
                flipped = flip != t.swaps_handedness();
            } else if (auto* patches = std::get_if<BilinearMesh>(&there)) {
                transform_mesh(*patches, t);
                flipped = flip != t.swaps_handedness();
            } else {
                there = placed(std::get<Quadric>(there), t);
            }
            b.add_shape(std::move(there), settings(e, flipped));
        });
    }

    // What a picture and holes refer to.
    static void prepare(Scene& scene) {
        Image map(8, 8, {"R", "G", "B"});
        for (int i = 0; i < 192; ++i)
            map.f32()[static_cast<std::size_t>(i)] = 0.2f + static_cast<float>(i * 7 % 11);
        scene.environments.push_back(map);
        TextureMapping six;
        six.su = six.sv = 6;
        scene.float_textures.push_back(
            CheckerboardTexture<FloatParameter>{2, six, {FloatParameter{1}, FloatParameter{0}}});
    }

  private:
    Scene made(const std::function<void(montelux::SceneBuilder&, const Emission&)>& add) const {
        Scene scene;
        scene.materials.resize(1);
        prepare(scene);
        CallMessages messages("a test");
        montelux::SceneBuilder builder(scene, messages);
        add(builder, emission());
        builder.finish();
        return scene;
    }
};

Geometry sheet(bool deforms, bool normals) {
    TriangleMesh m = emission::two_triangles();
    if (normals) m.normals.assign(m.positions.size(), {0.2f, 0.1f, -1});
    if (!deforms) return m;
    m.end_positions = {{-1, -2, 1}, {1, 1.5f, 0.5f}, {1, -1, 2}, {3, 1, 1}};
    if (normals) m.end_normals.assign(m.positions.size(), {-0.1f, 0.3f, -1});
    return m;
}

Geometry curved_patch() {
    BilinearMesh m;
    m.positions = {{-1, -1, 0}, {1, -1, 0.5f}, {-1, 1, 0.3f}, {1.2f, 1, -0.4f}};
    m.indices = {0, 1, 2, 3};
    return m;
}

std::vector<Emitter> emitters() {
    const Transform a = Transform::translate({1, 0, 1}) * Transform::rotate(20, {1, 0.3, 0}),
                    b = Transform::translate({-1, 2, 0}) * Transform::rotate(70, {1, 2, 0}),
                    lengthened = b * Transform::scale({1.7, 0.6, 1.2}),
                    mirrored_a = a * Transform::scale({-1, 1, 1}),
                    mirrored_b = b * Transform::scale({-0.5, 1, 2}),
                    tiny = a * Transform::scale({0.05, 0.05, 0.05}),
                    large = b * Transform::scale({2.5, 2.5, 2.5});
    const Quadric disk = Disk{.radius = 0.7f, .world_from_object = Transform::rotate(30, {0, 1, 0})},
                  ball = Sphere{.radius = 0.6f, .z_min = -0.6f, .z_max = 0.6f, .world_from_object = {}},
                  bowl = Sphere{.z_min = -0.5f, .z_max = 0.9f, .phi_max = 4, .world_from_object = {}},
                  ellipsoid = Sphere{.world_from_object = Transform::scale({1, 0.6, 0.8})},
                  tube = Cylinder{
                      .radius = 0.5f, .z_min = -1, .z_max = 2, .phi_max = 4, .world_from_object = {}};
    return {
        {"mesh", sheet(false, false), a, b},
        {"mesh with normals", sheet(false, true), a, lengthened},
        {"mesh of two sides, flipped", sheet(false, false), a, lengthened, true, 0, true},
        {"mirrored mesh", sheet(false, false), mirrored_a, mirrored_b},
        {"mirrored mesh with normals", sheet(false, true), mirrored_a, mirrored_b},
        {"mesh that grows", sheet(false, false), tiny, large},
        {"mesh of a given power that grows", sheet(false, false), tiny, large, false, 3},
        {"mesh that deforms", sheet(true, false), {}, {}},
        {"mesh with normals that deforms", sheet(true, true), b, b},
        {"mesh of a given power that deforms", sheet(true, false), {}, {}, true, 3},
        {"mesh that moves and deforms", sheet(true, false), mirrored_a, mirrored_b},
        {"patch", curved_patch(), a, b},
        {"patch of a given power that grows", curved_patch(), tiny, large, false, 3},
        {"mirrored patch", curved_patch(), mirrored_a, b * Transform::scale({-1, 1, 1})},
        {"disk", disk, a, b},
        {"disk, flipped", disk, a, lengthened, false, 0, true},
        {"mirrored disk", disk, mirrored_a, mirrored_b},
        {"sphere", ball, a, b},
        {"sphere that grows", ball, tiny, large},
        {"mirrored sphere", ball, mirrored_a, mirrored_b},
        {"sphere that is lengthened", ball, a, lengthened},
        {"part of a sphere", bowl, mirrored_a, mirrored_b, true},
        {"ellipsoid", ellipsoid, a, lengthened},
        {"part of a cylinder", tube, a, mirrored_b * Transform::scale({-1, 1, 1})},
        {"disk that does not move", disk, b, b},
        {"mesh with a picture", sheet(false, false), mirrored_a, mirrored_b, false, 0, false, true},
        {"disk with a picture", disk, a, lengthened, true, 0, false, true},
        {"sphere with a picture", ball, tiny, large, false, 0, false, true},
        {"mesh with holes that moves and deforms", sheet(true, false), a, lengthened, false, 0, false, false,
         true},
        {"sphere with holes", ball, a, lengthened, false, 0, false, false, true},
    };
}

bool near(float a, float b, float relative) {
    return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b));
}

LightHit hit_on(const SurfacePoint& s, Vec3f wi) {
    return {.wi = wi, .part = s.primitive, .p = s.p, .n = s.ng, .b = s.b};
}

// For the same random numbers: direction, radiance, density, and where the shadow ray ends.
TEST(MovingEmitters, AreSampledAsTheStillOneThatIsThere) {
    for (const Emitter& e : emitters()) {
        const World moving(e.moving());
        for (const float time : times) {
            const World still(e.still(time));
            Draws draws(3);
            int found = 0, differ = 0;
            for (int i = 0; i < 2000; ++i) {
                const ReferencePoint from{.p = draws.in_cube(6)};
                const Vec2f u = draws.uniform_2d();
                const Index parts = part_count({moving.tables.view(), 0});
                ASSERT_EQ(parts, part_count({still.tables.view(), 0}));
                const auto part = static_cast<Index>(i) % parts;
                const auto a = sample_li({moving.tables.view(), 0, time}, part, from, u, lambda);
                const auto b = sample_li({still.tables.view(), 0}, part, from, u, lambda);
                if (a.has_value() != b.has_value()) {
                    ++differ; // at the horizon, and where a cone is almost a hemisphere
                    continue;
                }
                found += a.has_value();
                if (!a) continue;
                const Vec3f p = a->shadow.o + a->shadow.d, q = b->shadow.o + b->shadow.d;
                const bool same = length(p - q) < 2e-3f && near(a->pdf, b->pdf, 1e-2f) &&
                                  near(a->radiance[0], b->radiance[0], 1e-3f);
                differ += !same; // close to the light or its plane
            }
            EXPECT_LT(differ, 20) << e.name << " at " << time;
            EXPECT_GT(found, 300) << e.name << " at " << time;
        }
    }
}

// A ray along a sample meets the light at that time where the sample is, with its density and radiance.
TEST(MovingEmitters, SamplesAgreeWithHits) {
    for (const Emitter& e : emitters()) {
        const World world(e.moving());
        const SceneView& view = world.tables.view();
        Draws draws(5);
        int met = 0, differ = 0;
        for (int i = 0; i < 10000; ++i) {
            const float time = draws.uniform();
            const ReferencePoint from{.p = draws.in_cube(6)};
            const Index part = static_cast<Index>(i) % part_count({view, 0});
            const auto s = sample_li({view, 0, time}, part, from, draws.uniform_2d(), lambda);
            if (!s) continue;
            const Ray ray{from.p, s->wi, std::numeric_limits<float>::infinity(), time};
            Hit hit;
            if (!world.accelerator.intersect(ray, hit) || hit.primitive != part) continue;
            ASSERT_EQ(view.light_at(hit), 0u);
            const SurfacePoint point = surface_point(view, ray, hit, false);
            if (length(point.p - (s->shadow.o + s->shadow.d)) > 1e-3f) continue; // another sheet of it
            ++met;
            const LightHit at = hit_on(point, s->wi);
            const bool same =
                near(pdf_li({view, 0, time}, from, at), s->pdf, 5e-3f) &&
                near(incident_radiance({view, 0, time}, from, at, lambda)[0], s->radiance[0], 1e-3f);
            differ += !same; // grazing
        }
        EXPECT_GT(met, 1000) << e.name;
        EXPECT_LT(differ, 1 + met / 100) << e.name;
    }
}

// Emission leaves the bounds that light trees are built from at no time, and its density is that of pdf_le.
TEST(MovingEmitters, StayWithinTheirBounds) {
    for (const Emitter& e : emitters()) {
        const World world(e.moving());
        const SceneView& view = world.tables.view();
        Draws draws(7);
        for (int i = 0; i < 4000; ++i) {
            const Index part = static_cast<Index>(i) % part_count({view, 0});
            const LightContext context{view, 0, draws.uniform()};
            const auto s = sample_le(context, part, draws.uniform_2d(), draws.uniform_2d(), lambda);
            if (!s) continue;
            EXPECT_EQ(s->ray.time, context.time);
            for (const auto& b : {motion_bounds({view, 0}, part), light_bounds(context, part)}) {
                ASSERT_TRUE(b.has_value());
                for (int k = 0; k < 3; ++k) {
                    ASSERT_GT(double(s->ray.o[k]), b->box.lower[k] - 1e-4) << e.name;
                    ASSERT_LT(double(s->ray.o[k]), b->box.upper[k] + 1e-4) << e.name;
                }
                float cosine = dot(s->n, b->axis);
                if (b->two_sided) cosine = std::abs(cosine);
                ASSERT_GT(cosine, b->cos_theta_o - 1e-5f) << e.name;
            }
            LightHit at{.part = part, .p = s->ray.o, .n = s->n};
            if (std::holds_alternative<BilinearMesh>(e.geometry)) continue; // its density wants u and v
            const EmissionPdf pdf = pdf_le(context, at, s->ray.d);
            ASSERT_TRUE(near(pdf.position, s->pdf_position, 2e-3f)) << e.name;
        }
    }
}

// A flat one that turns by less than a right angle has a cone, one that only travels its single normal.
TEST(MovingEmitters, BoundsAreTight) {
    const auto cone = [](const Transform& end) {
        const World world(Emitter{"disk", Quadric(Disk{.world_from_object = {}}), {}, end}.moving());
        return *motion_bounds({world.tables.view(), 0}, 0);
    };
    const LightBounds travels = cone(Transform::translate({9, 0, 0}));
    EXPECT_EQ(travels.cos_theta_o, 1);
    EXPECT_EQ(travels.axis.z, 1);
    EXPECT_NEAR(travels.box.upper.x, 10, 1e-6);
    EXPECT_NEAR(travels.box.lower.x, -1, 1e-6);
    const LightBounds turns = cone(Transform::rotate(60, {1, 0, 0}));
    EXPECT_NEAR(turns.cos_theta_o, std::cos(30 * pi / 180), 1e-3);
    EXPECT_NEAR(dot(turns.axis, Vec3f(Transform::rotate(30, {1, 0, 0}).vector(Vec3d{0, 0, 1}))), 1, 1e-5);
    EXPECT_NEAR(cone(Transform::rotate(179, {1, 0, 0})).cos_theta_o, std::cos(89.5 * pi / 180), 1e-3);
}

// Powers are means over the motion: a triangle that has no area at the start is found.
TEST(MovingEmitters, WithoutAreaAtTheStartHavePower) {
    TriangleMesh mesh = emission::two_triangles();
    mesh.end_positions = mesh.positions;
    for (Point3f& p : mesh.positions) p = {};
    const World world(Emitter{"mesh", mesh}.moving());
    double powers[2] = {};
    light_powers({world.tables.view(), 0}, powers);
    // Its area grows with the square of the time.
    EXPECT_NEAR(powers[0], 2 * pi * emission::area_of(0, 1, 2) / 3, 1e-5);
    EXPECT_NEAR(powers[1], 2 * pi * emission::area_of(2, 1, 3) / 3, 1e-5);
    const World grows(Emitter{"disk", Quadric(Disk{.world_from_object = {}}), Transform::scale({1, 1, 1}),
                              Transform::scale({3, 3, 3})}
                          .moving());
    light_powers({grows.tables.view(), 0}, std::span(powers).first(1));
    EXPECT_NEAR(powers[0], 2 * pi * pi * (1 + 2 + 4.0 / 3), 1e-3);
}

// Two uses of an object, or none: which would shine? And objects of files are dark.
TEST(MovingEmitters, OfObjectsShineIfTheObjectHasOneInstance) {
    Scene scene =
        Emitter{"disk", Quadric(Disk{.world_from_object = {}}), {}, Transform::translate({1, 0, 0})}.moving();
    const auto parts = [&] {
        const SceneTables tables(scene);
        Hit hit{.shape = 0, .instance = 0};
        EXPECT_EQ(tables.view().light_at(hit), part_count({tables.view(), 0}) > 0 ? 0 : no_index);
        return part_count({tables.view(), 0});
    };
    EXPECT_EQ(parts(), 1u);
    const SceneDigest before = digest_of(scene);
    scene.objects[0].shines = false;
    EXPECT_EQ(parts(), 0u);
    EXPECT_NE(digest_of(scene).geometry, before.geometry);
    scene.objects[0].shines = true;
    scene.instances.push_back(scene.instances[0]);
    EXPECT_EQ(parts(), 0u);
    scene.instances.clear();
    EXPECT_EQ(parts(), 0u);
}

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
        int lit = 0, dark = 0;
        for (int i = 0; i < 3000; ++i) {
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
        EXPECT_GT(lit, 10000);
        EXPECT_GT(dark, sampling == LightSampling::tree ? 1000 : -1);
    }
}

} // namespace
} // namespace montelux::testing
