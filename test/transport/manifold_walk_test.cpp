// Walks on specular manifolds against closed forms and differences of refracted rays.
#include "test/render/scene_testing.h"
#include "test/wavy_mesh.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/mc/math/frame.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/transport/manifold/manifold_walk.h"

namespace montelux::testing {
namespace {

// A scene of one caster.
struct CasterScene {
    explicit CasterScene(const SceneDescription& d)
        : description(d), tables(description.scene), accelerator(tables.view()), casters(tables.view()) {}

    SceneDescription description;
    SceneTables tables;
    Accelerator accelerator;
    Casters casters;

    const Caster& caster() const { return casters.all().front(); }
    std::optional<ManifoldSolution> walk(const ManifoldEnds& ends, PhiloxStream& stream) const {
        RayTracer tracer(accelerator);
        return walk_manifold(tables.view(), tracer, caster(), ends,
                             sample_point(tables.view(), caster(), stream));
    }
};

ManifoldEnds ends_of(Vec3d vertex, Vec3d light, bool distant = false) {
    ManifoldEnds ends;
    ends.from.p = Vec3f(vertex);
    ends.from.n = {0, 0, 1};
    ends.light = distant ? normalize(light) : light;
    ends.distant = distant;
    return ends;
}

Material mirror() {
    ConductorMaterial m;
    m.metal.from_reflectance = true;
    m.metal.reflectance = gray(1);
    return m;
}

// Where the plane of a caster's point, or its sphere, is met by the line from `o` along `d`.
CasterPoint met(const CasterScene& world, const CasterPoint& near, Vec3d o, Vec3d d) {
    const Caster& caster = world.caster();
    if (const auto* sphere = std::get_if<WorldSphere>(&caster.geometry)) {
        const Vec3d oc = o - sphere->center;
        const double b = dot(oc, d), c = dot(oc, oc) - sphere->radius * sphere->radius;
        const double root = std::sqrt(b * b - c);
        const double side =
            length(o + d * (-b - root) - near.p) < length(o + d * (-b + root) - near.p) ? -1 : 1;
        return quadric_point(caster, o + d * (-b + side * root));
    }
    const Vec3d n = cross(near.dpdu, near.dpdv);
    const Vec3d p = o + d * (dot(near.p - o, n) / dot(d, n));
    if (!std::holds_alternative<CasterMesh>(caster.geometry)) return quadric_point(caster, p);
    const Vec3d e = p - near.p;
    const double uu = dot(near.dpdu, near.dpdu), uv = dot(near.dpdu, near.dpdv),
                 vv = dot(near.dpdv, near.dpdv);
    const double eu = dot(e, near.dpdu), ev = dot(e, near.dpdv), det = uu * vv - uv * uv;
    return mesh_point(world.tables.view(), caster, near.primitive, near.b1 + (vv * eu - uv * ev) / det,
                      near.b2 + (uu * ev - uv * eu) / det);
}

// The ray that leaves the caster's point by the law of reflection or refraction.
Vec3d bent(const ManifoldSolution& s, const CasterPoint& point, Vec3d d, double eta) {
    Vec3d n = point.n;
    if (s.reflects) return d - n * (2 * dot(d, n));
    if (dot(d, n) > 0) {
        n = -n;
        eta = 1 / eta;
    }
    const double cosine = -dot(d, n);
    const double cos2 = 1 - (1 - cosine * cosine) / (eta * eta);
    return d / eta + n * (cosine / eta - std::sqrt(cos2));
}

// manifold_geometry by differences: the area at the light of a thin beam from the vertex.
double beam_geometry(const CasterScene& world, const ManifoldEnds& ends, const ManifoldSolution& s) {
    const Vec3d o = ends.vertex(), w = normalize(s.point.p - o);
    const auto across = FrameOf<double>::from_normal(w);
    const double h = 1e-5;
    const auto arrival = [&](double x, double y) {
        const Vec3d d = normalize(w + across.s * x + across.t * y);
        const CasterPoint point = met(world, s.point, o, d);
        const Vec3d out = bent(s, point, d, world.caster().eta);
        if (ends.distant) return out;
        const Vec3d n = normalize(ends.light - s.point.p);
        return point.p + out * (dot(ends.light - point.p, n) / dot(out, n));
    };
    const Vec3d dx = (arrival(h, 0) - arrival(-h, 0)) / (2 * h),
                dy = (arrival(0, h) - arrival(0, -h)) / (2 * h);
    return 1 / length(cross(dx, dy));
}

// Solutions obey the law, and their geometric term is that of a thin beam; at least so many of 200 walks end.
void expect_solutions(const CasterScene& world, const ManifoldEnds& ends, int least,
                      const std::string& name) {
    PhiloxStream stream(5);
    int found = 0;
    for (int i = 0; i < 200; ++i) {
        const auto s = world.walk(ends, stream);
        if (!s) continue;
        ++found;
        const Vec3d d = normalize(s->point.p - ends.vertex());
        const Vec3d out = bent(*s, s->point, d, world.caster().eta);
        const Vec3d to_light = ends.distant ? ends.light : normalize(ends.light - s->point.p);
        EXPECT_LT(length(out - to_light), 1e-7) << name;
        const double geometry = manifold_geometry(*s, ends, world.caster());
        EXPECT_NEAR(geometry / beam_geometry(world, ends, *s), 1, 1e-3) << name;
    }
    EXPECT_GE(found, least) << name;
}

TEST(ManifoldWalk, FindsTheImageInAPlaneMirror) {
    for (const bool disk : {false, true}) {
        SceneBuilder b;
        if (disk)
            b.add_quadric(Disk{.radius = 3, .world_from_object = Transform::translate({0, 0, 1})},
                          b.add(mirror()));
        else
            b.add_mesh(square(Transform::translate({0, 0, 1}) * Transform::scale({3, 3, 1})),
                       b.add(mirror()));
        const CasterScene world(b.description);
        ASSERT_EQ(world.casters.all().size(), 1u);
        const ManifoldEnds ends = ends_of({0.25, 0.5, -0.5}, {-1, 0.125, 0.5});
        const Vec3d image{-1, 0.125, 1.5};
        PhiloxStream stream(2);
        int found = 0;
        for (int i = 0; i < 100; ++i) {
            const auto s = world.walk(ends, stream);
            if (!s) continue; // a step may lead beyond the edge
            ++found;
            const Vec3d d = image - ends.vertex();
            EXPECT_LT(length(s->point.p - (ends.vertex() + d * (1.5 / 2))), 1e-7);
            EXPECT_NEAR(manifold_geometry(*s, ends, world.caster()) * length_squared(d), 1, 1e-6);
        }
        EXPECT_GE(found, 80) << disk;
    }
}

TEST(ManifoldWalk, TermsAreThoseOfThinBeams) {
    const Transform above = Transform::translate({0, 0, 1});
    for (const bool distant : {false, true})
        for (const double height : {0.0, 0.02, 0.05}) {
            const std::string name = "waves of " + std::to_string(height);
            SceneBuilder b;
            b.add_mesh(wavy_mesh(5 * height, 12, above), b.add(DielectricMaterial{1.33f}));
            const CasterScene water(b.description);
            expect_solutions(water, ends_of({0.2, 0.1, 0}, {0.3, -0.4, 3}, distant), 60, name);
            expect_solutions(water, ends_of({0.2, 0.1, 2}, {0.3, -0.4, -1}, distant), 60,
                             name + " from above");
            expect_solutions(water, ends_of({0.2, 0.1, 1.9}, {-0.3, 0.2, 2.5}, distant), 20,
                             name + " mirrored");
        }
    for (const bool flip : {false, true}) {
        SceneBuilder b;
        b.add_quadric(Sphere{.world_from_object = above}, b.add(DielectricMaterial{1.5f}), 0, flip);
        const CasterScene ball(b.description);
        expect_solutions(ball, ends_of({0.5, 1, -1}, {-2, 0.5, 1.5}), 20, "ball from outside");
        expect_solutions(ball, ends_of({0.1, 0.2, 0.7}, {-0.5, 0.4, 2.5}), flip ? 1 : 20, "ball from inside");
        expect_solutions(ball, ends_of({0.1, 0.2, 0.7}, {-0.5, 0.4, 2.5}, true), flip ? 1 : 20,
                         "ball from inside");
        SceneBuilder m;
        m.add_quadric(Sphere{.world_from_object = above}, m.add(mirror()), 0, flip);
        const CasterScene silver(m.description);
        expect_solutions(silver, ends_of({0.5, 1, -1}, {-2, 0.5, 1.5}), 20, "mirror ball");
        expect_solutions(silver, ends_of({0.3, 0.2, 0.8}, {-0.2, 0.1, 1.2}), 20, "hollow mirror");
    }
}

// A curved surface sends the light to a vertex in several ways. Each solution is found by the share of seeds whose
// inverse the repeated walks estimate.
TEST(ManifoldWalk, TrialsCountTheInverseProbability) {
    SceneBuilder b;
    b.add_mesh(wavy_mesh(0.6, 12, Transform::translate({0, 0, 1})), b.add(mirror()));
    const CasterScene waves(b.description);
    const ManifoldEnds ends = ends_of({0.2, 0.1, 0}, {0.3, -0.2, 0.2});
    PhiloxStream stream(9);
    std::vector<ManifoldSolution> distinct;
    std::vector<double> shares;
    constexpr int seeds = 20000;
    for (int i = 0; i < seeds; ++i) {
        const auto s = waves.walk(ends, stream);
        if (!s) continue;
        std::size_t k = 0;
        while (k < distinct.size() && !is_same(distinct[k], *s, ends)) ++k;
        if (k == distinct.size()) {
            distinct.push_back(*s);
            shares.push_back(0);
        }
        shares[k] += 1.0 / seeds;
    }
    ASSERT_GE(distinct.size(), 3u);
    RayTracer tracer(waves.accelerator);
    int tested = 0;
    for (std::size_t i = 0; i < distinct.size(); ++i) {
        // Not one solution under two names.
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_GT(length(distinct[i].point.p - distinct[k].point.p), 1e-4);
        if (shares[i] < 0.01) continue;
        ++tested;
        RunningMoments trials;
        for (int n = 0; n < 300; ++n)
            trials.add(double(
                inverse_probability(waves.tables.view(), tracer, waves.caster(), ends, distinct[i], stream)));
        // The error of the share is added to that of the mean.
        const double error =
            std::hypot(trials.standard_error() * shares[i], std::sqrt((1 - shares[i]) / (shares[i] * seeds)));
        EXPECT_LT(std::abs(trials.mean() * shares[i] - 1), 5 * error) << shares[i];
    }
    EXPECT_GE(tested, 3);
}

// A valley of two facets, nearly flat: each sends the light of a lamp above to a vertex above, and so close to the
// other's that only the facets tell them apart.
TEST(ManifoldWalk, SolutionsOnTwoFacetsAreTwo) {
    constexpr float slope = 1e-3f / 1024;
    SceneBuilder b;
    TriangleMesh valley;
    valley.positions = {{0, -1, 0}, {0, 1, 0}, {1, 0, slope}, {-1, 0, slope}};
    valley.indices = {0, 2, 1, 0, 1, 3};
    b.add_mesh(valley, b.add(mirror()));
    const CasterScene world(b.description);
    const ManifoldEnds ends = ends_of({0, 0, 1}, {0, 0.1, 1.25});
    PhiloxStream stream(3);
    std::vector<ManifoldSolution> found;
    for (int i = 0; i < 100; ++i)
        if (const auto s = world.walk(ends, stream)) found.push_back(*s);
    ASSERT_GT(found.size(), 50u);
    int same = 0;
    for (const ManifoldSolution& s : found) {
        EXPECT_LT(std::abs(s.point.p.x), 2e-6);
        if (is_same(s, found.front(), ends)) {
            ++same;
            EXPECT_EQ(s.point.p.x > 0, found.front().point.p.x > 0);
        }
    }
    EXPECT_GT(same, 10);
    EXPECT_LT(same, static_cast<int>(found.size()) - 10);
}

TEST(Casters, OfAllSizesAreChosen) {
    SceneBuilder b;
    b.add_mesh(square(Transform()), b.add(mirror()));
    b.add_mesh(square(Transform::scale({1e5, 1e5, 1})), b.add(mirror()));
    const SceneTables tables(b.scene);
    const Casters casters(tables.view());
    double of_small = 0, sum = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto [caster, probability] = casters.choose_caster((i + 0.5) / 1000);
        const bool small = caster == &casters.all().front();
        EXPECT_NEAR(probability, small ? 0.25 : 0.75, 1e-6);
        of_small += small;
        sum += 1 / probability;
    }
    EXPECT_NEAR(of_small, 250, 2);
    EXPECT_NEAR(sum / 1000, 2, 0.02);
}

TEST(Casters, AreSmoothAndAtRest) {
    SceneBuilder b;
    const TriangleMesh mesh = square(Transform());
    const auto count = [&](const Material& m) {
        SceneBuilder one(b);
        one.add_mesh(mesh, one.add(m));
        const SceneTables tables(one.scene);
        return Casters(tables.view()).all().size();
    };
    EXPECT_EQ(count(mirror()), 1u);
    EXPECT_EQ(count(DielectricMaterial{1.5f}), 1u);
    EXPECT_EQ(count(DielectricMaterial{1.0f}), 0u);
    EXPECT_EQ(count(DiffuseMaterial{gray(0.5f)}), 0u);
    DielectricMaterial rough{1.5f};
    rough.roughness.u = rough.roughness.v = {0.2f};
    EXPECT_EQ(count(rough), 0u);
    DielectricMaterial flint;
    flint.eta =
        add_spectrum(b.scene, Spectrum(PiecewiseLinear::from_pairs(std::array{360.0f, 1.8f, 830.0f, 1.5f})));
    EXPECT_EQ(count(flint), 0u);
    EXPECT_EQ(count(ThinDielectricMaterial{1.5f}), 0u);

    // A mesh that deforms is elsewhere at other times.
    SceneBuilder bending(b);
    TriangleMesh folded = mesh;
    for (const Point3f& p : mesh.positions) folded.end_positions.push_back(p + Vec3f{0, 0, p.x});
    bending.add_mesh(folded, bending.add(mirror()));
    EXPECT_TRUE(Casters(SceneTables(bending.scene).view()).all().empty());

    // Lights of all kinds but those all around.
    const SceneSpectrum white = white_light(b.scene);
    b.scene.lights.push_back(PointLight{white, 1, {0, 0, 2}});
    b.scene.lights.push_back(DistantLight{white, 1, {0, 0, 1}});
    b.add_uniform_light(1);
    b.add_mesh(square(Transform::translate({0, 0, 3})), b.add(DiffuseMaterial{gray(0)}), 2);
    const SceneTables tables(b.scene);
    const Casters none(tables.view());
    EXPECT_TRUE(none.empty());
    EXPECT_TRUE(none.covers(0));
    EXPECT_TRUE(none.covers(1));
    EXPECT_FALSE(none.covers(2));
    EXPECT_TRUE(none.covers(3));
}

} // namespace
} // namespace montelux::testing
