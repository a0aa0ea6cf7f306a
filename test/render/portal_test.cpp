// Pictures of rooms lit through portals. Each comparison is at 5 standard errors (a false alarm in 1.7
// million) plus rounding.
#include "test/render/scene_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/scene/light/portal.h"

namespace montelux::testing {
namespace {

// The rectangle [x0, x1] x [y0, y1] at z = 0 of `t`, normal +z.
TriangleMesh rectangle(double x0, double y0, double x1, double y1, const Transform& t) {
    return square(t * Transform::translate({(x0 + x1) / 2, (y0 + y1) / 2, 0}) *
                  Transform::scale({(x1 - x0) / 2, (y1 - y0) / 2, 1}));
}

// A box of side 4 around the origin whose wall at y = 2 has a window of 1 x 1.5, and the portal in it.
SceneBuilder room_with_window() {
    SceneBuilder b;
    const Index wall = b.add(DiffuseMaterial{gray(0.6f)});
    ConductorMaterial metal;
    metal.roughness = {FloatParameter{0.3f}, FloatParameter{0.3f}, false};
    metal.metal.reflectance = gray(0.7f);
    metal.metal.from_reflectance = true;
    const Index floor = b.add(metal);
    const Transform back = Transform::translate({0, 2, 0}) * Transform::rotate(90, {1, 0, 0}); // z up is y
    b.add_mesh(rectangle(-2, -2, -0.5, 2, back), wall);
    b.add_mesh(rectangle(0.5, -2, 2, 2, back), wall);
    b.add_mesh(rectangle(-0.5, -2, 0.5, -0.5, back), wall);
    b.add_mesh(rectangle(-0.5, 1, 0.5, 2, back), wall);
    b.add_mesh(rectangle(-2, -2, 2, 2, Transform::translate({0, 0, -2})), floor);
    b.add_mesh(rectangle(-2, -2, 2, 2, Transform::translate({0, 0, 2})), wall);
    b.add_mesh(rectangle(-2, -2, 2, 2, Transform::translate({0, -2, 0}) * Transform::rotate(90, {1, 0, 0})),
               wall);
    b.add_mesh(rectangle(-2, -2, 2, 2, Transform::translate({2, 0, 0}) * Transform::rotate(90, {0, 1, 0})),
               wall);
    b.add_mesh(rectangle(-2, -2, 2, 2, Transform::translate({-2, 0, 0}) * Transform::rotate(90, {0, 1, 0})),
               wall);
    b.look({-1, -1.5, 0.5}, {0.8, 1.9, -0.8}, 70); // the window is in the picture
    b.description.integrator.max_depth = 4;
    return b;
}
const Portal window({Point3f{-0.5f, 2, -0.5f}, {0.5f, 2, -0.5f}, {0.5f, 2, 1}, {-0.5f, 2, 1}});

TEST(Portals, RoomIsTheSameWithEachStrategyAndWithoutThem) {
    struct Case {
        Strategy strategy;
        bool portal;
    };
    // Without a portal directions to the map would hardly find the window.
    const std::vector<Case> cases{{Strategy::mis, true},
                                  {Strategy::light, true},
                                  {Strategy::bsdf, true},
                                  {Strategy::bsdf, false},
                                  {Strategy::mis, false}};
    for (int kind : {0, 1, 2}) {
        std::vector<PictureMean> means;
        for (const Case& c : cases) {
            SceneBuilder b = room_with_window();
            std::optional<Portal> portal;
            if (c.portal) portal = window;
            if (kind == 0) {
                b.scene.lights.push_back(UniformInfiniteLight{white_light(b.scene), white_scale(), portal});
            } else {
                Image map(kind == 1 ? 8 : 16, 8, {"R", "G", "B"});
                for (int i = 0; i < map.width() * 8; ++i)
                    for (int k = 0; k < 3; ++k)
                        map.set(i % map.width(), i / map.width(), k,
                                0.1f + static_cast<float>((i * 7) % 11) / 4);
                b.scene.environments.push_back(map);
                b.scene.lights.push_back(ImageInfiniteLight{
                    .environment = 0,
                    .layout = kind == 1 ? EnvironmentLayout::equal_area : EnvironmentLayout::equirectangular,
                    .scale = white_scale(),
                    .world_from_light = Transform::rotate(30, {1, 2, 3}),
                    .portal = portal});
            }
            b.description.integrator.strategy = c.strategy;
            b.description.sampler.spp = c.portal && c.strategy != Strategy::bsdf ? 128 : 512;
            means.push_back(picture_mean(render(b.description)));
        }
        for (std::size_t i = 1; i < means.size(); ++i)
            EXPECT_NEAR(means[i].mean, means[0].mean,
                        5 * std::hypot(means[i].standard_error, means[0].standard_error))
                << "light " << kind << ", case " << i;
        EXPECT_LT(means[0].standard_error, 0.1 * means[0].mean);
    }
}

// A floor under a rectangular hole in a dark ceiling that nothing but the portal describes: the irradiance of
// a rectangle parallel to the plane, with a corner above the point.
TEST(Portals, FloorUnderAnOpeningIsKnown) {
    const double x = 1.5, y = 0.8, h = 1.25, rho = 0.6, radiance = 2;
    auto part = [](double a, double b) {
        return a / std::sqrt(1 + a * a) * std::atan(b / std::sqrt(1 + a * a));
    };
    const double form_factor = (part(x / h, y / h) + part(y / h, x / h)) / (2 * pi);
    for (Strategy strategy : {Strategy::uniform, Strategy::bsdf, Strategy::light, Strategy::mis}) {
        SceneBuilder b;
        b.add_mesh(square(Transform::scale({10, 10, 1})), b.add(DiffuseMaterial{gray(float(rho))}));
        b.look({3, 1, 0.9}, {0, 0, 0}, 0.01f);
        const auto fx = static_cast<float>(x), fy = static_cast<float>(y), fh = static_cast<float>(h);
        b.scene.lights.push_back(
            UniformInfiniteLight{white_light(b.scene), static_cast<float>(radiance) * white_scale(),
                                 Portal({Point3f{0, 0, fh}, {0, fy, fh}, {fx, fy, fh}, {fx, 0, fh}})});
        b.description.integrator.strategy = strategy;
        b.description.sampler.spp = 512;
        const PictureMean m = picture_mean(render(b.description));
        const double truth = rho * form_factor * radiance;
        EXPECT_NEAR(m.mean, truth, 5 * m.standard_error + 2e-3 * truth) << int(strategy);
    }
}

// The camera sees the light through the portal, black beside it, and nothing from the other side.
TEST(Portals, CameraSeesTheLightThroughThem) {
    const std::array<Point3f, 4> corners{
        Point3f{-0.5f, -0.5f, 1}, {-0.5f, 0.5f, 1}, {0.5f, 0.5f, 1}, {0.5f, -0.5f, 1}};
    for (auto [eye, share] : {std::pair(0.0, 0.25), {0.5, 1.0}, {2.0, 0.0}}) {
        SceneBuilder b;
        b.look({0, 0, eye}, {0, 0, eye < 1 ? 9. : -9.}, 90);
        b.scene.lights.push_back(UniformInfiniteLight{white_light(b.scene), white_scale(), Portal(corners)});
        b.description.sampler.spp = 16;
        const PictureMean m = picture_mean(render(b.description));
        EXPECT_NEAR(m.mean, share, 5 * m.standard_error + 2e-4) << eye;
    }
}

} // namespace
} // namespace montelux::testing
