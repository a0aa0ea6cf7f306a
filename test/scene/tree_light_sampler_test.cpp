// The tree of lights: its probabilities are those of its choices, for any point; they add up to 1, and no light
// that reaches the point is left out. Chi-squared tests at the level of significance.h: below 1e-4 for the file.
#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "montelux/mc/math/lane_functions.h"
#include "montelux/mc/math/vec_lanes.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/light/sampler/light_cone.h"
#include "montelux/scene/light/sampler/tree_light_sampler.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/spectrum/wavelengths.h"

namespace montelux {
namespace {

class Numbers {
  public:
    explicit Numbers(std::uint64_t seed) : uniforms_(seed) {}
    double next() { return uniforms_.next(); }
    double between(double a, double b) { return a + (b - a) * next(); }
    Vec2f pair() { return {static_cast<float>(next()), static_cast<float>(next())}; }
    Vec3f direction() { return sample_uniform_sphere(pair()); }
    Vec3f in_cube(double half) {
        return {static_cast<float>(between(-half, half)), static_cast<float>(between(-half, half)),
                static_cast<float>(between(-half, half))};
    }

  private:
    TestUniforms uniforms_;
};

struct Emitters {
    std::string name;
    Scene scene;
    double size = 1; // of the space around the lights
};

void add_triangle(Scene& scene, Vec3f p, Vec3f e1, Vec3f e2, float radiance, bool two_sided = false) {
    const auto shape = static_cast<Index>(scene.shapes.size());
    Shape s;
    s.geometry = MeshIndex{static_cast<Index>(scene.meshes.size())};
    s.light = static_cast<Index>(scene.lights.size());
    TriangleMesh mesh;
    mesh.positions = {p, p + e1, p + e2};
    mesh.indices = {0, 1, 2};
    scene.meshes.push_back(std::move(mesh));
    scene.shapes.push_back(s);
    scene.world_shapes.push_back(shape);
    scene.lights.push_back(AreaLight{1.0f, radiance, two_sided, shape});
}

// Triangles, points, spots and spheres in a cube.
Emitters mixed(std::string name, int count, double size, std::uint64_t seed) {
    Emitters e{std::move(name), {}, size};
    Numbers r(seed);
    const auto s = static_cast<float>(size);
    for (int i = 0; i < count; ++i) {
        const Vec3f p = r.in_cube(size);
        const auto power = static_cast<float>(std::exp(r.between(-4, 4)));
        switch (i % 5) {
        case 0:
            e.scene.lights.push_back(PointLight{1.0f, power, p});
            break;
        case 1:
            e.scene.lights.push_back(SpotLight{1.0f, power, p, r.direction(), 0.9f, 0.7f});
            break;
        default: {
            const float edge = s * static_cast<float>(std::exp(r.between(-6, -1)));
            add_triangle(e.scene, p, edge * r.direction(), edge * r.direction(), power, i % 7 == 0);
        }
        }
    }
    return e;
}

std::vector<Emitters> all_emitters() {
    std::vector<Emitters> all;
    for (const int count : {3, 8, 9, 40, 300})
        all.push_back(mixed("mixed " + std::to_string(count), count, 1, 7 + static_cast<unsigned>(count)));
    all.push_back(mixed("tiny", 60, 1e-6, 3));
    all.push_back(mixed("huge", 60, 1e6, 4));
    all.push_back(mixed("far away", 60, 1, 5));
    for (Light& light : all.back().scene.lights)
        if (auto* point = std::get_if<PointLight>(&light)) point->position += Vec3f(1000, 0, 0);
    Emitters one_place{"one place", {}, 1};
    for (int i = 0; i < 100; ++i)
        one_place.scene.lights.push_back(PointLight{1.0f, static_cast<float>(1 + i), {0.5f, 0, 0}});
    all.push_back(std::move(one_place));
    Emitters line{"a line", {}, 1};
    for (int i = 0; i < 50; ++i)
        line.scene.lights.push_back(
            SpotLight{1.0f, 1, {0.02f * static_cast<float>(i), 0, 0}, {0, 0, 1}, 0.9f, 0.8f});
    all.push_back(std::move(line));
    Emitters halving{"each half as far", {}, 1}; // the deepest tree by its costs
    for (int i = 0; i < 120; ++i)
        halving.scene.lights.push_back(PointLight{1.0f, 1, {std::ldexp(1.0f, -i), 0, 0}});
    all.push_back(std::move(halving));
    Emitters unequal{"powers from 1e-30 to 1e30", {}, 1};
    Numbers r(8);
    for (int i = 0; i <= 60; ++i)
        unequal.scene.lights.push_back(
            PointLight{1.0f, std::pow(10.0f, static_cast<float>(i - 30)), r.in_cube(1)});
    unequal.scene.lights.push_back(PointLight{1.0f, 0, {0, 0, 0}});
    all.push_back(std::move(unequal));
    Emitters one_side{"a plane", {}, 1};
    for (int i = 0; i < 64; ++i)
        add_triangle(one_side.scene,
                     {0.25f * static_cast<float>(i % 8) - 1, 0.25f * static_cast<float>(i / 8) - 1, 0},
                     {0.2f, 0, 0}, {0, 0.2f, 0}, 1);
    all.push_back(std::move(one_side));
    for (const int infinite : {1, 3}) {
        Emitters sky = mixed("with " + std::to_string(infinite) + " infinite lights", 20, 1, 9);
        for (int i = 0; i < infinite; ++i)
            sky.scene.lights.push_back(UniformInfiniteLight{1.0f, 0.3f * static_cast<float>(i + 1)});
        all.push_back(std::move(sky));
    }
    return all;
}

// Inside and outside, near lights and on them, with and without a side.
std::vector<ReferencePoint> points_around(const Emitters& e, int count) {
    std::vector<ReferencePoint> points(1);
    Numbers r(11);
    for (int i = 0; i < count; ++i) {
        ReferencePoint from;
        from.p = r.in_cube(e.size * std::pow(10.0, i % 4 - 1));
        if (i % 3 == 0)
            if (const auto* light = std::get_if<PointLight>(&e.scene.lights[0])) from.p = light->position;
        if (i % 5 == 1 && !e.scene.meshes.empty())
            from.p = e.scene.meshes[static_cast<std::size_t>(i) % e.scene.meshes.size()].positions[0];
        from.n = r.direction();
        if (i % 2 == 0) from.facing = from.n;
        points.push_back(from);
    }
    points.push_back({.p = {0, 0, 0}, .facing = {0, 0, -1}});
    points.push_back({.p = {static_cast<float>(3 * e.size), 0, 0}, .facing = {1, 0, 0}}); // away from all
    points.push_back({.p = {1e30f, 0, 0}});
    return points;
}

struct Sampler {
    explicit Sampler(const Scene& scene) : tables(scene, {}, LightSampling::tree) {}
    const LightSampler& operator*() const { return *tables.view().light_sampler; }
    SceneTables tables;
};

TEST(TreeLightSampler, ProbabilitiesAddUpToOne) {
    for (const Emitters& e : all_emitters()) {
        const Sampler sampler(e.scene);
        for (const ReferencePoint& from : points_around(e, 100)) {
            double sum = 0;
            for (Index light = 0; light < e.scene.lights.size(); ++light) {
                const float p = (*sampler).probability(from, light, 0);
                EXPECT_GE(p, 0);
                sum += double(p);
            }
            ASSERT_NEAR(sum, 1, 1e-5) << e.name;
        }
    }
}

TEST(TreeLightSampler, ChoosesAsOftenAsItsProbabilitySays) {
    for (const Emitters& e : all_emitters()) {
        const Sampler sampler(e.scene);
        Numbers r(12);
        for (const ReferencePoint& from : points_around(e, 8)) {
            constexpr int n = 20000;
            const std::size_t count = e.scene.lights.size();
            std::vector<double> observed(count), expected(count), left(32);
            for (Index light = 0; light < count; ++light)
                expected[light] = n * double((*sampler).probability(from, light, 0));
            for (int i = 0; i < n; ++i) {
                const LightChoice c = (*sampler).sample(from, r.next());
                ASSERT_EQ(c.part, 0u);
                ASSERT_GT(c.probability, 0) << e.name;
                ASSERT_EQ(c.probability, (*sampler).probability(from, c.light, c.part)) << e.name;
                ASSERT_TRUE(c.remapped >= 0 && c.remapped < 1) << c.remapped;
                observed[c.light] += 1;
                left[static_cast<std::size_t>(c.remapped * 32)] += 1;
            }
            EXPECT_TRUE(chi_squared_test(observed, expected).passes(significance)) << e.name;
            EXPECT_TRUE(chi_squared_test(left, std::vector<double>(32, n / 32.0)).passes(significance))
                << e.name;
        }
    }
}

// The ends of the interval, where rounding could lead to a light that cannot be chosen.
TEST(TreeLightSampler, EveryNumberChoosesALight) {
    for (const Emitters& e : all_emitters()) {
        const Sampler sampler(e.scene);
        for (const ReferencePoint& from : points_around(e, 50))
            for (const double u : {0.0, 1e-300, 0x1p-53, 0.5, 1 - 0x1p-24, 1 - 0x1p-53}) {
                const LightChoice c = (*sampler).sample(from, u);
                ASSERT_LT(c.light, e.scene.lights.size());
                ASSERT_GT(c.probability, 0);
                ASSERT_EQ(c.probability, (*sampler).probability(from, c.light, c.part));
                ASSERT_TRUE(c.remapped >= 0 && c.remapped < 1) << c.remapped;
            }
    }
}

// Light that arrives on the side that the point faces can be chosen.
TEST(TreeLightSampler, EveryLightThatReachesThePointHasAProbability) {
    const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);
    int lit = 0, dark = 0;
    for (const Emitters& e : all_emitters()) {
        const Sampler sampler(e.scene);
        Numbers r(13);
        for (const ReferencePoint& from : points_around(e, 200))
            for (Index light = 0; light < e.scene.lights.size(); ++light) {
                const bool possible = (*sampler).probability(from, light, 0) > 0;
                if (!possible) ++dark;
                for (int i = 0; i < 4; ++i) {
                    const auto s = sample_li({sampler.tables.view(), light}, 0, from, r.pair(), lambda);
                    if (!s || is_black(s->radiance)) continue;
                    if (!(from.facing == Vec3f{}) && dot(s->wi, from.facing) <= 0) continue;
                    ++lit;
                    ASSERT_TRUE(possible) << e.name << ", light " << light;
                }
            }
    }
    EXPECT_GT(lit, 10000);
    EXPECT_GT(dark, 1000);
}

// On the planes of triangles and at the edges of cones, where rounding decides.
TEST(TreeLightSampler, GrazingLightHasAProbability) {
    Emitters e{"a plane", {}, 1};
    Numbers r(14);
    for (int i = 0; i < 100; ++i)
        add_triangle(e.scene, r.in_cube(1), 0.1f * r.direction(), 0.1f * r.direction(), 1);
    const Sampler sampler(e.scene);
    const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);
    int lit = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto light = static_cast<Index>(i % 100);
        const LightTriangle& t = sampler.tables.view().light_tables.triangle(light, 0);
        // Just above the plane of the light, or facing so that the light is just above the horizon.
        const Vec3f in_plane = normalize(t.e1 + static_cast<float>(r.between(-1, 1)) * t.e2);
        const float distance = static_cast<float>(std::exp(r.between(-8, 3)));
        ReferencePoint from{.p = t.p0 + distance * in_plane};
        from.p += static_cast<float>(std::exp(r.between(-16, -9))) * distance * t.n;
        const auto s = sample_li({sampler.tables.view(), light}, 0, from, r.pair(), lambda);
        if (!s) continue;
        const Vec3f across = normalize(cross(s->wi, r.direction()));
        from.facing = normalize(across + 1e-6f * s->wi);
        if (dot(from.facing, s->wi) <= 0) continue;
        ++lit;
        ASSERT_GT((*sampler).probability(from, light, 0), 0) << i;
    }
    EXPECT_GT(lit, 1000);
}

TEST(TreeLightSampler, LightsOfPowerZeroAreNeverChosen) {
    Scene scene;
    for (int i = 0; i < 20; ++i)
        scene.lights.push_back(PointLight{1.0f, i % 3 == 0 ? 0.0f : 1.0f, {static_cast<float>(i), 0, 0}});
    const Sampler sampler(scene);
    for (Index light = 0; light < 20; ++light)
        EXPECT_EQ((*sampler).probability({}, light, 0) > 0, light % 3 != 0);
    Numbers r(15);
    for (int i = 0; i < 1000; ++i) EXPECT_NE((*sampler).sample({}, r.next()).light % 3, 0u);
    for (Light& light : scene.lights) std::get<PointLight>(light).scale = 0;
    const Sampler black(scene);
    EXPECT_EQ((*black).probability({}, 7, 0), 1 / 20.0f);
}

TEST(TreeLightSampler, NearLightsAndThoseThatShineHereAreMoreLikely) {
    Scene scene;
    for (int i = 0; i < 1000; ++i) scene.lights.push_back(PointLight{1.0f, 1, {static_cast<float>(i), 0, 0}});
    const Sampler sampler(scene);
    EXPECT_GT((*sampler).probability({.p = {500, 0, 0.5f}}, 500, 0), 0.1f);
    EXPECT_LT((*sampler).probability({.p = {500, 0, 0.5f}}, 0, 0), 1e-4f);
    Scene two_rows;
    for (int i = 0; i < 64; ++i)
        two_rows.lights.push_back(
            SpotLight{1.0f, 1, {static_cast<float>(i), 0, 0}, {0, 0, i % 2 == 0 ? 1.0f : -1.0f}, 0.9f, 0.5f});
    const Sampler up(two_rows);
    double from_below = 0;
    for (Index light = 1; light < 64; light += 2)
        from_below += double((*up).probability({.p = {32, 0, 5}}, light, 0));
    EXPECT_LT(from_below, 0.2);
}

// Lanes have the bits of a single group.
TEST(LightImportance, InLanesAsAlone) {
    Numbers r(16);
    for (int i = 0; i < 1000; ++i) {
        LightGroup<Lanes<8>> groups;
        std::array<LightGroup<float>, 8> alone;
        for (int k = 0; k < 8; ++k) {
            LightGroup<float>& g = alone[static_cast<std::size_t>(k)];
            g.center = r.in_cube(1);
            g.radius = static_cast<float>(std::exp(r.between(-6, 0)));
            g.axis = r.direction();
            g.cos_theta_o = static_cast<float>(r.between(-1, 1));
            g.sin_theta_o = std::sqrt(1 - g.cos_theta_o * g.cos_theta_o);
            g.cos_theta_e = static_cast<float>(r.between(-1, 1));
            g.two_sided = k % 2 == 0 ? 1 : 0;
            g.intensity = static_cast<float>(r.next());
            set_lane(groups.center, k, g.center);
            set_lane(groups.axis, k, g.axis);
            groups.radius.set(k, g.radius);
            groups.cos_theta_o.set(k, g.cos_theta_o);
            groups.sin_theta_o.set(k, g.sin_theta_o);
            groups.cos_theta_e.set(k, g.cos_theta_e);
            groups.two_sided.set(k, g.two_sided);
            groups.intensity.set(k, g.intensity);
        }
        const LitPoint at{r.in_cube(2), i % 2 == 0 ? r.direction() : Vec3f{}};
        const Lanes<8> together = light_importance(groups, at);
        for (int k = 0; k < 8; ++k)
            ASSERT_EQ(together[k], light_importance(alone[static_cast<std::size_t>(k)], at));
    }
}

TEST(LightCones, MeasuresAreTheFluxOfUnitIntensity) {
    const auto measure = [](float cos_theta_o, float cos_theta_e, bool two_sided) {
        return LightCone(LightBounds{{}, {0, 0, 1}, cos_theta_o, cos_theta_e, two_sided}).measure();
    };
    EXPECT_NEAR(measure(-1, 0, false), 4 * pi, 1e-5);
    EXPECT_NEAR(measure(1, 0, false), pi, 1e-5);
    EXPECT_NEAR(measure(1, 0, true), 2 * pi, 1e-5);
    EXPECT_NEAR(measure(1, 0.9f, false), pi * (1 - 0.81), 1e-5);
}

TEST(LightCones, ContainWhatIsAddedToThem) {
    Numbers r(17);
    for (int i = 0; i < 2000; ++i) {
        const double spread = r.between(0, 2);
        std::vector<LightCone> cones;
        for (int k = 0; k < 6; ++k) {
            LightBounds b;
            b.axis = normalize(Vec3f(0, 0, 1) + static_cast<float>(spread) * r.direction());
            b.cos_theta_o = k % 2 == 0 ? 1 : static_cast<float>(std::cos(r.between(0, 1)));
            b.cos_theta_e = static_cast<float>(r.between(-1, 1));
            b.two_sided = i % 4 == 0 && k == 3;
            cones.emplace_back(b);
        }
        LightCone all = cones[0];
        for (const LightCone& cone : cones) all.add(cone);
        const double theta = std::acos(std::clamp(double(all.cos_theta_o), -1.0, 1.0));
        for (const LightCone& cone : cones) {
            double between = std::acos(std::clamp(double(dot(all.axis, cone.axis)), -1.0, 1.0));
            if (all.two_sided) between = std::min(between, pi - between);
            EXPECT_LE(between + std::acos(std::clamp(double(cone.cos_theta_o), -1.0, 1.0)), theta + 1e-3);
            EXPECT_LE(all.cos_theta_e, cone.cos_theta_e);
            EXPECT_TRUE(all.two_sided || !cone.two_sided);
        }
    }
}

} // namespace
} // namespace montelux
