// Cut-outs. Shares are compared at 5.5 standard errors of a binomial count: a false alarm in 26 million each,
// 4e-7 for the file.
#include "test/accel/accel_testing.h"
#include <gtest/gtest.h>

namespace montelux::testing {
namespace {

// The square [-1, 1]^2 at height z, with uv from (0, 0) to (1, 1).
TriangleMesh sheet(float z) {
    TriangleMesh m;
    m.positions = {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}};
    m.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    m.indices = {0, 1, 2, 0, 2, 3};
    return m;
}

Ray down(Draws& draws) {
    float x = draws.uniform(-0.99f, 0.99f), y = draws.uniform(-0.99f, 0.99f);
    float dx = draws.uniform(-1e-3f, 1e-3f);
    return {{x, y, 5}, {dx, 0, -1}};
}

void expect_share(int count, int n, double share, const char* what) {
    EXPECT_NEAR(double(count) / n, share, 5.5 * std::sqrt(share * (1 - share) / n)) << what;
}

// Two independent surfaces of alpha 1/2 let a quarter of the rays through.
void expect_a_quarter_through(Scene scene, std::uint64_t seed, const char* what) {
    World world(std::move(scene));
    Draws draws(seed);
    constexpr int n = 100000;
    int through = 0;
    for (int i = 0; i < n; ++i) through += !world.accelerator.occluded(down(draws));
    expect_share(through, n, 0.25, what);
}

TEST(Alpha, AConstantIsAProbability) {
    for (float alpha : {0.0f, 0.3f, 0.9f, 1.0f}) {
        Scene scene;
        Index front = add_shape(scene, sheet(0));
        add_shape(scene, sheet(-1));
        scene.shapes[front].alpha = {alpha};
        World world(std::move(scene));
        Draws draws(1);
        constexpr int n = 100000;
        int hits = 0;
        for (int i = 0; i < n; ++i) {
            Ray ray = down(draws);
            Hit hit;
            // Where the front is not, the sheet behind is seen.
            ASSERT_TRUE(world.accelerator.intersect(ray, hit));
            bool on_front = hit.shape == front;
            hits += on_front;
            ray.t_max = 5.5f;
            ASSERT_EQ(world.accelerator.occluded(ray), on_front);
        }
        expect_share(hits, n, double(alpha), "sheet");
        if (alpha == 0 || alpha == 1) {
            EXPECT_EQ(hits, static_cast<int>(alpha) * n);
        }
    }
}

TEST(Alpha, AConstantOnQuadrics) {
    const Quadric cases[] = {Disk{}, Sphere{.z_min = 0, .world_from_object = {}}};
    for (const Quadric& quadric : cases) {
        Scene scene;
        Index shape = add_shape(scene, quadric);
        scene.shapes[shape].alpha = {0.3f};
        World world(std::move(scene));
        Draws draws(2);
        int n = 0, hits = 0;
        for (int i = 0; i < 100000; ++i) {
            Ray ray = down(draws);
            if (std::hypot(ray.o.x, ray.o.y) > 0.98f) continue;
            ++n;
            Hit hit;
            bool found = world.accelerator.intersect(ray, hit);
            hits += found;
            ASSERT_EQ(world.accelerator.occluded(ray), found);
        }
        expect_share(hits, n, 0.3, "quadric");
    }
}

TEST(Alpha, StackedLayersAreIndependent) {
    for (bool quadrics : {false, true}) {
        Scene scene;
        for (float z : {0.0f, -1.0f}) {
            Index s = quadrics
                          ? add_shape(scene, Quadric(Disk{.height = z, .radius = 2, .world_from_object = {}}))
                          : add_shape(scene, sheet(z));
            scene.shapes[s].alpha = {0.5f};
        }
        expect_a_quarter_through(std::move(scene), 3, quadrics ? "disks" : "sheets");
    }
}

TEST(Alpha, TrianglesOfOneMeshAreIndependent) {
    TriangleMesh mesh = sheet(0);
    const TriangleMesh below = sheet(-1);
    mesh.positions.insert(mesh.positions.end(), below.positions.begin(), below.positions.end());
    mesh.uvs.insert(mesh.uvs.end(), below.uvs.begin(), below.uvs.end());
    for (const Index vertex : below.indices) mesh.indices.push_back(vertex + 4);
    Scene scene;
    scene.shapes[add_shape(scene, std::move(mesh))].alpha = {0.5f};
    expect_a_quarter_through(std::move(scene), 5, "two sheets of a mesh");
}

TEST(Alpha, BothSidesOfASphereAreIndependent) {
    Scene scene;
    Index s =
        add_shape(scene, Quadric(Sphere{.radius = 2, .z_min = -2, .z_max = 2, .world_from_object = {}}));
    scene.shapes[s].alpha = {0.5f};
    expect_a_quarter_through(std::move(scene), 4, "sphere");
}

// A mask of 0 and 1 cuts exactly, seen along any ray; u and v run as the vertices say, also in an instance.
TEST(Alpha, ATextureCutsWhereItSays) {
    for (bool instance : {false, true}) {
        Scene scene;
        Index shape = add_shape(scene, sheet(0), !instance);
        if (instance) {
            scene.objects.push_back({{shape}});
            scene.instances.push_back({0, Transform::rotate(90, {0, 0, 1})});
        }
        CheckerboardTexture<FloatParameter> checks;
        checks.mapping.su = 4;
        checks.mapping.sv = 2;
        checks.values = {FloatParameter{0}, FloatParameter{1}};
        scene.float_textures.push_back(checks);
        scene.shapes[shape].alpha = {0, 0};
        World world(std::move(scene));
        Draws draws(5);
        for (int i = 0; i < 20000; ++i) {
            Ray ray = down(draws);
            Hit hit;
            bool found = world.accelerator.intersect(ray, hit);
            Vec3f p = ray.o + 5.0f * ray.d;
            if (instance) p = {p.y, -p.x, 0};
            float s = 4 * 0.5f * (p.x + 1), t = 2 * 0.5f * (p.y + 1);
            if (std::abs(s - std::round(s)) < 1e-4f || std::abs(t - std::round(t)) < 1e-4f) continue;
            bool there = (static_cast<int>(s) + static_cast<int>(t)) % 2 == 1;
            ASSERT_EQ(found, there) << s << ' ' << t;
            ASSERT_EQ(world.accelerator.occluded(ray), there);
        }
    }
}

// The uv of quadrics reach the mask too.
TEST(Alpha, ATextureCutsADisk) {
    Scene scene;
    Index shape = add_shape(scene, Quadric(Disk{.radius = 2, .world_from_object = {}}));
    CheckerboardTexture<FloatParameter> checks;
    checks.mapping.su = 8;
    checks.mapping.sv = 1;
    checks.values = {FloatParameter{0}, FloatParameter{1}};
    scene.float_textures.push_back(checks);
    scene.shapes[shape].alpha = {0, 0};
    World world(std::move(scene));
    Draws draws(6);
    for (int i = 0; i < 20000; ++i) {
        Ray ray = down(draws);
        Vec3f p = ray.o + 5.0f * ray.d;
        double phi = std::atan2(double(p.y), double(p.x));
        double sector = (phi < 0 ? phi + 2 * pi : phi) / (pi / 4);
        if (std::abs(sector - std::round(sector)) < 1e-3) continue;
        ASSERT_EQ(world.accelerator.occluded(ray), static_cast<int>(sector) % 2 == 1) << sector;
    }
}

} // namespace
} // namespace montelux::testing
