// What is tabulated for lights with portals: densities that miss no texel, and their power.
#include "test/scene/portal_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <utility>

#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/light/environment/portal_sampler.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux::portals {
namespace {

// One bright texel on black: wherever it is seen it is drawn, and no sample of it counts for much more than
// the light that there is.
TEST(Portals, NoCornerOfATexelIsLeftOut) {
    for (auto [width, height] : {std::pair(64, 64), {128, 64}})
        for (int texel : {1029, 1700, 2080, 4000}) {
            Image map(width, height, {"R", "G", "B"});
            for (int c = 0; c < 3; ++c) map.set(texel % width, texel / width, c, 1000);
            Scene scene;
            scene.environments.push_back(map);
            ImageInfiniteLight light;
            light.environment = 0;
            light.layout = *layout_of_size(width, height);
            const EnvironmentGrid grid(light.layout, width, height);
            // Out of a portal's middle, near its horizon, and near the corners of the plane of angles.
            for (Vec3d towards : {Vec3d{0.1, 0.2, 1}, {0, 1, 0.06}, {0.7, -0.7, 0.03}}) {
                const Vec3d middle(grid.direction(
                    {static_cast<float>(texel % width) + 0.5f, static_cast<float>(texel / width) + 0.5f}));
                const Vec3d axis = cross(middle, normalize(towards));
                light.world_from_light = Transform::rotate(
                    std::atan2(length(axis), dot(middle, normalize(towards))) * 180 / pi, axis);
                light.portal = Portal(corners_of(-500, -500, 500, 500));
                scene.lights = {light};
                const SceneTables tables(scene);
                TestUniforms uniforms(7);
                const Point3f p{0, 0, -1};
                int seen = 0;
                for (int i = 0; i < 300; ++i) {
                    const Vec2f u = uniforms.next_2f();
                    const Vec3f w(normalize(light.world_from_light.vector(
                        Vec3d(grid.direction({static_cast<float>(texel % width) + u.x,
                                              static_cast<float>(texel / width) + u.y})))));
                    const auto radiance =
                        incident_radiance({tables.view(), 0}, {.p = p}, {.wi = w}, wavelengths);
                    if (is_black(radiance)) continue;
                    ++seen;
                    // 1 / (solid angle of the texel) if it alone were drawn.
                    const double share =
                        static_cast<double>(pdf_li({tables.view(), 0}, {.p = p}, {.wi = w})) *
                        grid.solid_angle(texel / width);
                    ASSERT_GT(share, 0.005) << width << " " << texel << " " << towards.z;
                }
                EXPECT_GT(seen, 30) << width << " " << texel << " " << towards.z;
            }
        }
}

// Chosen by the flux through the portal, but by no more than what the scene can catch.
TEST(Portals, PowerIsTheFluxThroughThem) {
    Scene scene;
    scene.lights.push_back(UniformInfiniteLight{1.0f, 3, Portal(corners_of(0, 0, 2, 3))});
    scene.lights.push_back(UniformInfiniteLight{1.0f, 3, Portal(corners_of(-1e3f, -1e3f, 1e3f, 1e3f))});
    scene.lights.push_back(PointLight{1.0f, 1, {0, 0, 0}});
    scene.quadrics.push_back(Quadric(Sphere{.world_from_object = Transform::scale({4, 4, 4})}));
    Shape shape;
    shape.geometry = QuadricIndex{0};
    scene.shapes.push_back(shape);
    scene.world_shapes.push_back(0);
    scene.environments.push_back(Image(16, 16, {"R", "G", "B"}));
    for (float& texel : scene.environments[0].f32()) texel = 1;
    ImageInfiniteLight map;
    map.environment = 0;
    scene.lights.push_back(map);
    map.portal = Portal(corners_of(0, 0, 2, 3));
    scene.lights.push_back(map);
    const SceneTables tables(scene, {}, LightSampling::power);
    const LightSampler& lights = *tables.view().light_sampler;
    const double r = tables.view().light_tables.scene_bounds.radius(), cross_section = pi * r * r;
    const double point = static_cast<double>(lights.probability({}, 2, 0)) / (4 * pi);
    EXPECT_NEAR(static_cast<double>(lights.probability({}, 0, 0)) / point, pi * 6 * 3, 1e-2);
    EXPECT_NEAR(static_cast<double>(lights.probability({}, 1, 0)) / point, 2 * pi * cross_section * 3, 1e-1);
    EXPECT_NEAR(static_cast<double>(lights.probability({}, 4, 0) / lights.probability({}, 3, 0)),
                pi * 6 / (4 * pi * cross_section), 1e-5);
}

// Sums have the same bits for any number of threads, as checkpoints and ranks require.
TEST(Portals, TablesDoNotDependOnThreads) {
    Image map(32, 32, {"R", "G", "B"});
    TestUniforms uniforms(6);
    for (float& texel : map.f32()) texel = uniforms.next_float();
    const Portal portal(corners_of(-1, -1, 1, 1));
    const auto made = [&] {
        return PortalSampler(map, EnvironmentLayout::equal_area, Transform::rotate(30, {1, 2, 3}), portal);
    };
    const PortalSampler one = with_threads(1, made);
    EXPECT_GT(one.fluence(), 0);
    for (int i = 0; i < 10; ++i) {
        const PortalSampler more = with_threads(2 + i % 3, made);
        ASSERT_EQ(more.fluence(), one.fluence());
        ASSERT_EQ(more.irradiance(), one.irradiance());
        const Vec2f u = uniforms.next_2f();
        const auto a = one.sample_direction(u), b = more.sample_direction(u);
        ASSERT_TRUE(a && b);
        EXPECT_EQ(a->wi, b->wi);
        EXPECT_EQ(a->pdf, b->pdf);
    }
}

} // namespace
} // namespace montelux::portals
