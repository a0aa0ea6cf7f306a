// Embree's callbacks in packets of rays: the hits are those of the rays alone.
#include "test/accel/accel_testing.h"
#include <gtest/gtest.h>
#include <vector>

#include "montelux/accel/embree_scene.h"
#include "montelux/accel/packets.h"

namespace montelux::testing {
namespace {

// Quadrics and meshes, the first of each with random holes, and moving instances.
Scene scene_of_all_geometry() {
    Scene scene;
    Draws draws(7);
    scene.shapes[add_shape(scene, soup(draws, 300, 0.4f))].alpha = {0.5f};
    const Quadric holed = Sphere{.radius = 0.7f, .z_min = -0.7f, .z_max = 0.4f, .world_from_object = {}};
    scene.shapes[add_shape(scene, holed)].alpha = {0.5f};
    add_shape(scene, Quadric(Disk{.height = -0.5f, .radius = 3, .world_from_object = {}}));
    add_shape(scene,
              Quadric(Cylinder{.radius = 0.4f, .phi_max = 5, .world_from_object = draws.transform(1, true)}));
    Curves curves;
    for (int i = 0; i < 50; ++i) {
        auto& points = curves.control_points.emplace_back();
        for (Point3f& p : points) p = draws.in_cube(1.5f);
        curves.widths.push_back({0.05f, 0.1f});
    }
    scene.shapes[add_shape(scene, curves)].alpha = {0.7f};
    const Index mesh = add_shape(scene, soup(draws, 50, 0.6f), false);
    const Index sphere = add_shape(
        scene, Quadric(Sphere{.radius = 0.3f, .z_min = -0.3f, .z_max = 0.3f, .world_from_object = {}}),
        false);
    scene.objects.push_back({.shapes = {mesh, sphere}});
    for (Index i = 0; i < 3; ++i) {
        const Transform start = draws.transform(1, false), end = draws.transform(1, false);
        scene.motions.emplace_back(start, end);
        scene.instances.push_back({.object = 0, .world_from_object = start, .motion = i});
    }
    return scene;
}

template <std::size_t K>
std::vector<BareHit> traced(const EmbreeScene& scene, bool closest, const std::vector<Ray>& rays) {
    std::vector<BareHit> hits;
    std::vector<const Ray*> pointers;
    pointers.reserve(rays.size());
    for (const Ray& ray : rays) pointers.push_back(&ray);
    QueryContext context(false);
    for (std::size_t first = 0; first < rays.size(); first += K) {
        const std::size_t count = std::min(K, rays.size() - first);
        const std::span<const Ray* const> some(&pointers[first], count);
        Packet<K> packet(some);
        if (closest)
            packet.closest(scene.world(), context);
        else
            packet.any(scene.world(), context);
        for (std::size_t i = 0; i < count; ++i) hits.push_back(packet.hit(i));
    }
    return hits;
}

// Rounding may differ, so that a ray in thousands meets another surface at an edge.
template <std::size_t K>
void expect_same_hits() {
    const World world(scene_of_all_geometry());
    const EmbreeScene scene(world.tables.view());
    Draws draws(11);
    std::vector<Ray> rays;
    for (int i = 0; i < 20003; ++i) {
        const Vec3f o = draws.in_cube(2);
        const Vec3f d = draws.direction();
        const float t_max = draws.uniform() < 0.5f ? 1.5f : 10.0f;
        rays.push_back({o, d, t_max, draws.uniform()}); // each ray of a packet at a time of its own
    }
    for (const bool closest : {true, false}) {
        const std::vector<BareHit> alone = traced<1>(scene, closest, rays),
                                   packets = traced<K>(scene, closest, rays);
        std::size_t other = 0, hits = 0, on_quadrics = 0, on_instances = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const BareHit &a = alone[i], &b = packets[i];
            const bool hit = closest ? a.shape != RTC_INVALID_GEOMETRY_ID : a.t < 0;
            hits += hit;
            on_quadrics += a.shape == 1 || a.shape == 2;
            on_instances += a.instance != RTC_INVALID_GEOMETRY_ID;
            const bool same = a.shape == b.shape && a.primitive == b.primitive && a.instance == b.instance &&
                              (std::abs(a.t - b.t) <= 1e-5f * std::abs(a.t) || a.t == b.t);
            other += !same;
        }
        EXPECT_GT(hits, rays.size() / 10);
        EXPECT_LT(hits, rays.size() * 9 / 10);
        EXPECT_LE(other, 20u) << (closest ? "closest" : "any");
        if (closest) {
            EXPECT_GT(on_quadrics, 1000u);
            EXPECT_GT(on_instances, 1000u);
        }
    }
}

TEST(Packets, OfFourHitAsRaysAlone) { expect_same_hits<4>(); }
TEST(Packets, OfEightHitAsRaysAlone) { expect_same_hits<8>(); }
TEST(Packets, OfSixteenHitAsRaysAlone) { expect_same_hits<16>(); }

} // namespace
} // namespace montelux::testing
