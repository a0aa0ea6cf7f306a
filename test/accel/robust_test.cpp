// Rays that leave a surface do not hit it again, at any size and distance from the origin; closed surfaces
// have no holes. Nothing is left to chance: the draws are fixed, and not one ray in millions may fail.
#include "test/accel/accel_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/light/light_sampling.h"

namespace montelux::testing {
namespace {

// Directions on the side of n, half of them within a few degrees of the surface.
Vec3f leaving(Draws& draws, Vec3f n) {
    Vec3f d = draws.direction();
    float grazing = draws.uniform(), height = draws.uniform(1e-4f, 0.05f);
    if (dot(d, n) < 0) d = -d;
    if (grazing < 0.5f) d = normalize(d - (dot(d, n) - height) * n);
    return d;
}

struct SelfHits {
    int rays = 0, again = 0;
};

// Rays from around hit a convex shape, and new rays leave it where they did. Anything they hit is the shape.
// `outside`: of hits from without alone, where the inside sees the shape.
SelfHits count_self_hits(const World& world, Vec3f center, float radius, int rays, Draws& draws,
                         bool outside) {
    SelfHits count;
    for (int i = 0; i < rays; ++i) {
        Vec3f o = center + 3 * radius * draws.direction();
        Ray ray{o, normalize(center + draws.in_cube(0.8f * radius) - o)};
        Hit hit;
        if (!world.accelerator.intersect(ray, hit)) continue;
        SurfacePoint s = surface_point(world.tables.view(), ray, hit, false);
        if (outside && dot(s.ng, ray.d) > 0) continue;
        Vec3f n = dot(s.ng, ray.d) < 0 ? s.ng : -s.ng;
        for (int k = 0; k < 4; ++k) {
            Vec3f w = leaving(draws, n);
            ++count.rays;
            Hit ignored;
            count.again += world.accelerator.intersect({offset_origin(s.p, s.ng, s.error, w), w}, ignored);
        }
    }
    return count;
}

// Sizes from 1/1000 of a unit to 10000 units, at distances from none to a thousand times the size.
template <typename Add>
void expect_no_self_hits(const Add& add, int rays_each, const char* what, bool outside = false) {
    Draws draws(17);
    int total = 0;
    for (float size : {1e-3f, 1e-1f, 1.0f, 30.0f, 1e4f})
        for (float distance : {0.0f, 1.0f, 30.0f, 1000.0f}) {
            Vec3f center = distance * size * draws.direction();
            Scene scene;
            add(scene, center, size, draws);
            World world(std::move(scene));
            SelfHits count = count_self_hits(world, center, size, rays_each, draws, outside);
            EXPECT_EQ(count.again, 0)
                << what << " of size " << size << " at " << distance << " sizes, of " << count.rays;
            total += count.rays;
        }
    EXPECT_GT(total, 10 * rays_each);
}

TEST(Robust, RaysLeaveTriangles) {
    // One triangle at a time: whatever is hit is the triangle left. Any orientation, slivers too.
    expect_no_self_hits(
        [](Scene& scene, Vec3f center, float size, Draws& draws) {
            TriangleMesh mesh;
            for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + draws.in_cube(size));
            mesh.indices = {0, 1, 2};
            add_shape(scene, std::move(mesh));
        },
        40000, "triangle");
}

// Flat along one axis or two: what reaches far across adds nothing to the error along the normal. `flatness`
// is how far the surface leaves its height, in sizes.
void expect_small_offsets(float flatness) {
    Draws draws(37);
    for (int axis = 0; axis < 3; ++axis)
        for (float size : {1e-2f, 1.0f, 1e5f})
            for (float height : {0.0f, 0.3f, 50.0f})
                for (bool disk : {false, true}) {
                    Scene scene;
                    auto place = [&](float a, float b, float c) {
                        Vec3f p;
                        p[axis] = height + flatness * size * c;
                        p[(axis + 1) % 3] = size * a;
                        p[(axis + 2) % 3] = size * b;
                        return p;
                    };
                    const Vec3d axes[] = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
                    if (disk) {
                        const Transform to_axis = axis == 2 ? Transform() : Transform::rotate(90, axes[axis]);
                        add_shape(scene,
                                  Quadric(Disk{.radius = size,
                                               .world_from_object =
                                                   Transform::translate(Vec3d(place(0, 0, 0))) * to_axis}));
                    } else {
                        TriangleMesh mesh;
                        mesh.positions = {place(-1, -1, 0), place(1, -1, 1), place(0, 1, -1)};
                        mesh.indices = {0, 1, 2};
                        add_shape(scene, std::move(mesh));
                    }
                    const World world(std::move(scene));
                    int again = 0, rays = 0;
                    for (int i = 0; i < 8000; ++i) {
                        const float a = draws.uniform(-0.5f, 0.5f), b = draws.uniform(-0.6f, 0.2f);
                        Vec3f o = place(a, b, 0);
                        o[axis] += draws.uniform(0.1f, 2) * size;
                        Vec3f d = draws.direction();
                        d[axis] = -std::abs(d[axis]);
                        const Ray ray{o, d};
                        Hit hit;
                        if (!world.accelerator.intersect(ray, hit)) continue;
                        const SurfacePoint s = surface_point(world.tables.view(), ray, hit, false);
                        ASSERT_LE(s.error, 4e-6f * (height + flatness * size) + 1e-11f * size);
                        const Vec3f n = dot(s.ng, ray.d) < 0 ? s.ng : -s.ng;
                        for (int k = 0; k < 4; ++k, ++rays) {
                            const Vec3f w = leaving(draws, n);
                            again +=
                                world.accelerator.intersect({offset_origin(s.p, s.ng, s.error, w), w}, hit);
                        }
                    }
                    EXPECT_GT(rays, 3200);
                    EXPECT_EQ(again, 0) << axis << ' ' << size << ' ' << height << ' ' << disk;
                }
}
TEST(Robust, OffsetsOfLargeFloorsAreSmall) { expect_small_offsets(0); }
TEST(Robust, OffsetsOfGentleSlopesAreSmall) {
    for (float flatness : {1e-7f, 1e-5f, 1e-2f}) expect_small_offsets(flatness);
}

TEST(Robust, RaysLeaveMeshesOfSpheres) {
    expect_no_self_hits([](Scene& scene, Vec3f center, float size,
                           Draws&) { add_shape(scene, geodesic_sphere(2, center, size)); },
                        20000, "mesh");
}

TEST(Robust, RaysLeaveSpheres) {
    expect_no_self_hits(
        [](Scene& scene, Vec3f center, float size, Draws&) {
            add_shape(scene, Quadric(Sphere{.radius = size,
                                            .z_min = -size,
                                            .z_max = size,
                                            .world_from_object = Transform::translate(Vec3d(center))}));
        },
        20000, "sphere");
}

TEST(Robust, RaysLeaveCylinders) {
    for (const bool whole : {false, true})
        expect_no_self_hits(
            [&](Scene& scene, Vec3f center, float size, Draws& draws) {
                const double angle = draws.uniform(0, 360);
                const Vec3d axis(draws.direction());
                add_shape(scene, Quadric(Cylinder{.radius = 0.5f * size,
                                                  .z_min = -0.5f * size,
                                                  .z_max = size,
                                                  .phi_max = whole ? 6.2831853f : 4,
                                                  .world_from_object = Transform::translate(Vec3d(center)) *
                                                                       Transform::rotate(angle, axis) *
                                                                       Transform::scale({1, -0.7, 0.5})}));
            },
            20000, whole ? "cylinder" : "part of a cylinder", true);
}

// The size in the transform instead of in the radius.
TEST(Robust, RaysLeaveScaledSpheresAndDisks) {
    for (bool disk : {false, true})
        expect_no_self_hits(
            [&](Scene& scene, Vec3f center, float size, Draws& draws) {
                double angle = draws.uniform(0, 360);
                Vec3d axis(draws.direction());
                Transform t = Transform::translate(Vec3d(center)) * Transform::rotate(angle, axis) *
                              Transform::scale({size, 0.7 * size, 0.5 * size});
                add_shape(scene, disk ? Quadric(Disk{.world_from_object = t})
                                      : Quadric(Sphere{.world_from_object = t}));
            },
            8000, disk ? "disk" : "ellipsoid");
}

TEST(Robust, RaysLeaveInstances) {
    for (bool quadric : {false, true})
        expect_no_self_hits(
            [&](Scene& scene, Vec3f center, float size, Draws& draws) {
                Index s = quadric ? add_shape(scene, Quadric(Sphere{}), false)
                                  : add_shape(scene, geodesic_sphere(2, {0, 0, 0}, 1), false);
                scene.objects.push_back({{s}});
                double angle = draws.uniform(0, 360);
                Vec3d axis(draws.direction());
                scene.instances.push_back(
                    {0, Transform::translate(Vec3d(center)) * Transform::rotate(angle, axis) *
                            Transform::scale({size, -0.8 * size, 0.6 * size})});
            },
            8000, quadric ? "instance of a sphere" : "instance of a mesh");
}

// Rays from within a closed mesh come to its wall, also those that aim at an edge. Embree's robust mode is
// tight along edges but not at vertices: of rays that aim straight at one, at most one in a thousand may slip
// through.
TEST(Robust, ClosedMeshesHaveNoHoles) {
    enum { anywhere, edge, vertex };
    Draws draws(23);
    for (float size : {1e-3f, 1.0f, 1e4f})
        for (float distance : {0.0f, 10.0f, 1000.0f}) {
            Vec3f center = distance * size * draws.direction();
            Scene scene;
            add_shape(scene, geodesic_sphere(4, center, size));
            World world(std::move(scene));
            const TriangleMesh& mesh = world.scene.meshes[0];
            const auto faces = static_cast<float>(mesh.triangle_count());
            constexpr int rays = 40000;
            for (int aim : {anywhere, edge, vertex}) {
                int escaped = 0;
                for (int i = 0; i < rays; ++i) {
                    Vec3f o = center + draws.in_cube(0.4f * size);
                    auto face = static_cast<std::size_t>(draws.uniform() * faces) * 3;
                    Vec3f a = mesh.positions[mesh.indices[face]], b = mesh.positions[mesh.indices[face + 1]];
                    float t = draws.uniform();
                    Vec3f d = aim == anywhere ? draws.direction() : (aim == edge ? a + t * (b - a) : a) - o;
                    Ray ray{o, normalize(d)};
                    Hit hit;
                    escaped += !world.accelerator.intersect(ray, hit) || !world.accelerator.occluded(ray);
                }
                EXPECT_LE(escaped, aim == vertex ? rays / 1000 : 0) << size << ' ' << distance << ' ' << aim;
            }
        }
}

// A ray that enters a sphere leaves it on the far side: the offset is along the ray.
TEST(Robust, RaysCrossClosedShapes) {
    Draws draws(29);
    for (float size : {1e-3f, 1.0f, 1e4f})
        for (bool mesh : {false, true}) {
            Vec3f center = 10 * size * draws.direction();
            Scene scene;
            if (mesh)
                add_shape(scene, geodesic_sphere(3, center, size));
            else
                add_shape(scene, Quadric(Sphere{.radius = size,
                                                .z_min = -size,
                                                .z_max = size,
                                                .world_from_object = Transform::translate(Vec3d(center))}));
            World world(std::move(scene));
            for (int i = 0; i < 50000; ++i) {
                Vec3f o = center + 3 * size * draws.direction();
                Ray ray{o, normalize(center + draws.in_cube(0.5f * size) - o)};
                Hit hit;
                ASSERT_TRUE(world.accelerator.intersect(ray, hit));
                SurfacePoint s = surface_point(world.tables.view(), ray, hit, false);
                Vec3f w = draws.direction();
                if (dot(w, s.ng) > 0) w = -w;
                if (dot(w, s.ng) > -0.05f) continue;
                Ray inside{offset_origin(s.p, s.ng, s.error, w), w};
                ASSERT_TRUE(world.accelerator.intersect(inside, hit)) << size;
                ASSERT_GT(hit.t, mesh ? 0 : 0.09f * size) << size;
            }
        }
}

// Between a floor and a light over it there is nothing: no shadow ray may be stopped by either.
TEST(Robust, ShadowRaysReachTheirLights) {
    Draws draws(31);
    for (float size : {1e-3f, 1.0f, 1e4f})
        for (float distance : {0.0f, 30.0f})
            for (int kind = 0; kind < 4; ++kind) {
                Vec3f center = distance * size * draws.direction();
                Transform at = Transform::translate(Vec3d(center)) * Transform::scale({size, size, size});
                Scene scene;
                TriangleMesh floor;
                for (Vec3d p : {Vec3d{-1, -1, 0}, Vec3d{1, -1, 0}, Vec3d{0, 1, 0}})
                    floor.positions.push_back(Vec3f(at.point(p)));
                floor.indices = {0, 1, 2};
                add_shape(scene, std::move(floor));
                Transform above = at * Transform::translate({0.3, 0.1, 1});
                Transform tilted = above * Transform::rotate(160, {1, 0.4, 0});
                Index light = no_index;
                if (kind == 0)
                    light = add_shape(
                        scene,
                        Quadric(Sphere{
                            .radius = 0.5f, .z_min = -0.5f, .z_max = 0.5f, .world_from_object = above}));
                else if (kind == 1)
                    light = add_shape(scene, Quadric(Disk{.world_from_object = tilted}));
                else if (kind == 2)
                    light = add_shape(
                        scene, Quadric(Sphere{.radius = 0.5f,
                                              .z_min = -0.5f,
                                              .z_max = 0.2f,
                                              .world_from_object = above * Transform::scale({1, 0.5, 0.8})}));
                else {
                    TriangleMesh lamp;
                    for (Vec3d p : {Vec3d{-1, -1, 0}, Vec3d{1, -1, 0}, Vec3d{0, 1, 0}})
                        lamp.positions.push_back(Vec3f(tilted.point(p)));
                    lamp.indices = {0, 1, 2};
                    light = add_shape(scene, std::move(lamp));
                }
                scene.shapes[light].light = 0;
                scene.lights.push_back(AreaLight{1.0f, 1, false, light});
                World world(std::move(scene));
                SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);
                int blocked = 0, sampled = 0;
                for (int i = 0; i < 20000; ++i) {
                    float x = draws.uniform(-0.3f, 0.3f), y = draws.uniform(-0.5f, 0.1f);
                    Vec3f from = Vec3f(at.point(Vec3d{x, y, 0.5}));
                    Ray ray{from, {0, 0, -1}};
                    Hit hit;
                    ASSERT_TRUE(world.accelerator.intersect(ray, hit));
                    if (hit.shape != 0) continue; // from within the lamp
                    SurfacePoint s = surface_point(world.tables.view(), ray, hit, false);
                    Vec2f u = draws.uniform_2d();
                    auto sample = sample_li({world.tables.view(), 0}, 0, {s.p, s.ng, s.error}, u, lambda);
                    if (!sample) continue;
                    // A partial sphere hides some of its own points, and what lies under the floor is hidden.
                    if (dot(sample->wi, s.ng) < 1e-3f) continue;
                    ++sampled;
                    blocked += world.accelerator.occluded(sample->shadow);
                }
                EXPECT_GT(sampled, 4000) << kind;
                if (kind == 2)
                    EXPECT_LT(blocked, sampled / 2) << kind << ' ' << size << ' ' << distance;
                else
                    EXPECT_EQ(blocked, 0) << kind << ' ' << size << ' ' << distance;
            }
}

} // namespace
} // namespace montelux::testing
