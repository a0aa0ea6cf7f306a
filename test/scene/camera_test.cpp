// Cameras against algebra. Nothing here is random but for fixed draws of film and lens points.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/camera/camera.h"

namespace montelux {
namespace {

constexpr Vec2f pinhole{0.5f, 0.5f};

void expect_vec(Vec3f a, Vec3d b, double tolerance = 1e-5) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

TEST(Camera, PerspectiveByTheFieldOfView) {
    // 60 degrees over the shorter axis of 200 x 100 pixels: the top edge is 30 degrees up, the side twice as
    // far in tangent.
    Camera camera({PerspectiveCamera{.fov = 60}, {}}, 200, 100);
    double t = std::tan(pi / 6);
    expect_vec(camera.generate_ray({100, 50}, pinhole).d, {0, 0, 1});
    expect_vec(camera.generate_ray({100, 0}, pinhole).d, normalize(Vec3d{0, t, 1}));
    expect_vec(camera.generate_ray({0, 100}, pinhole).d, normalize(Vec3d{-2 * t, -t, 1}));
    expect_vec(camera.generate_ray({200, 50}, pinhole).d, normalize(Vec3d{2 * t, 0, 1}));
    EXPECT_FALSE(camera.has_lens());
    // Upright pictures: the shorter axis is the width.
    Camera upright({PerspectiveCamera{.fov = 60}, {}}, 100, 200);
    expect_vec(upright.generate_ray({100, 0}, pinhole).d, normalize(Vec3d{t, 2 * t, 1}));
}

TEST(Camera, WindowAndAspectRatio) {
    PerspectiveCamera model{.fov = 90, .screen_window = ScreenWindow{-0.5f, 1, -2, 0.25f}};
    Camera camera({model, {}}, 30, 20);
    expect_vec(camera.generate_ray({0, 0}, pinhole).d, normalize(Vec3d{-0.5, 0.25, 1}));
    expect_vec(camera.generate_ray({30, 20}, pinhole).d, normalize(Vec3d{1, -2, 1}));
    Camera wide({PerspectiveCamera{.fov = 90, .frame_aspect_ratio = 2.0f}, {}}, 100, 100);
    expect_vec(wide.generate_ray({100, 0}, pinhole).d, normalize(Vec3d{2, 1, 1}));
}

TEST(Camera, IsPlacedByItsTransform) {
    Transform t = *Transform::look_at({1, 2, 3}, {4, 6, 3}, {0, 0, 1});
    Camera camera({PerspectiveCamera{.fov = 90}, t.inverse()}, 100, 100);
    Ray middle = camera.generate_ray({50, 50}, pinhole);
    expect_vec(middle.o, {1, 2, 3});
    expect_vec(middle.d, {0.6, 0.8, 0});
    Ray top = camera.generate_ray({50, 0}, pinhole);
    expect_vec(top.d, normalize(Vec3d{0.6, 0.8, 1}));
    EXPECT_NEAR(length(top.d), 1, 1e-6);
}

// The shorter side of the film covers [-3, 3], whatever its shape.
TEST(Camera, OrthographicScale) {
    for (const auto& [width, height] : {std::pair{200, 100}, std::pair{100, 300}}) {
        const Camera camera({OrthographicCamera{.scale = 3}, {}}, width, height);
        const double pixel = 6.0 / std::min(width, height);
        expect_vec(camera.generate_ray({0, 0}, pinhole).o, {-0.5 * width * pixel, 0.5 * height * pixel, 0});
    }
}

TEST(Camera, OrthographicRaysAreParallel) {
    Transform t = Transform::translate({0, 0, -7}) * Transform::scale({3, 3, 3});
    Camera camera({OrthographicCamera{}, t}, 200, 100);
    for (Vec2f film : {Vec2f{0, 0}, Vec2f{200, 100}, Vec2f{37.5f, 81}}) {
        Ray ray = camera.generate_ray(film, pinhole);
        expect_vec(ray.d, {0, 0, 1});
        expect_vec(ray.o, {3 * (-2 + 4 * double(film.x) / 200), 3 * (1 - 2 * double(film.y) / 100), -7});
    }
}

TEST(Camera, LatitudeAndLongitude) {
    Camera camera({SphericalCamera{SphericalCamera::Mapping::equirectangular}, {}}, 400, 200);
    // The top row looks up (+y), the middle row around the horizon.
    expect_vec(camera.generate_ray({123, 0}, pinhole).d, {0, 1, 0});
    expect_vec(camera.generate_ray({7, 200}, pinhole).d, {0, -1, 0});
    expect_vec(camera.generate_ray({0, 100}, pinhole).d, {1, 0, 0});
    expect_vec(camera.generate_ray({100, 100}, pinhole).d, {0, 0, 1});
    expect_vec(camera.generate_ray({50, 50}, pinhole).d, {0.5, std::sqrt(0.5), 0.5});
}

// Equal areas of the film see equal solid angles, and the whole film sees every direction once.
TEST(Camera, EqualAreaMap) {
    constexpr int n = 256;
    Camera camera({SphericalCamera{}, {}}, n, n);
    for (int y = 3; y < n - 4; y += 31)
        for (int x = 3; x < n - 4; x += 29) {
            if (std::abs(x - n / 2) < 3 || std::abs(y - n / 2) < 3 || std::abs(x - y) < 3 ||
                std::abs(x + y - n) < 3)
                continue; // folds of the map
            auto d = [&](float dx, float dy) {
                return Vec3d(
                    camera.generate_ray({static_cast<float>(x) + dx, static_cast<float>(y) + dy}, pinhole).d);
            };
            Vec3d across = d(1, 0) - d(-1, 0), down = d(0, 1) - d(0, -1);
            EXPECT_NEAR(length(cross(across, down)) / 4 * n * n / (4 * pi), 1, 0.02) << x << ' ' << y;
        }
    Vec3d sum;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            sum = sum + Vec3d(camera
                                  .generate_ray({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f},
                                                pinhole)
                                  .d);
    EXPECT_LT(length(sum) / (n * n), 1e-3);
    // Filters extend over the edges: there the map continues as on the sphere.
    for (float along : {0.0f, 11.3f, 128.0f, 200.7f, 256.0f})
        for (int side = 0; side < 4; ++side) {
            auto direction = [&](float out) {
                const float across = side % 2 == 0 ? -out : n + out;
                const Point2f film = side < 2 ? Point2f{across, along} : Point2f{along, across};
                return Vec3d(camera.generate_ray(film, pinhole).d);
            };
            const double step = length(direction(-1) - direction(0));
            EXPECT_NEAR(length(direction(1) - direction(0)), step, 1e-3 * step) << along << ' ' << side;
        }
}

// All rays of a film point meet on the plane in focus, and start all over the lens.
TEST(Camera, ThinLens) {
    Transform t = *Transform::look_at({1, 2, 3}, {4, 6, 5}, {0, 0, 1});
    const CameraModel models[] = {PerspectiveCamera{.fov = 50, .lens_radius = 0.3f, .focal_distance = 5},
                                  OrthographicCamera{.lens_radius = 0.3f, .focal_distance = 5}};
    for (const CameraModel& model : models) {
        Camera camera({model, t.inverse()}, 64, 48);
        EXPECT_TRUE(camera.has_lens());
        TestUniforms uniforms(3);
        for (int i = 0; i < 20; ++i) {
            Vec2f u_film = uniforms.next_2f();
            Vec2f film{64 * u_film.x, 48 * u_film.y};
            auto at_focus = [&](const Ray& ray) {
                Vec3d o = t.point(Vec3d(ray.o)), d = t.vector(Vec3d(ray.d));
                return o + d * ((5 - o.z) / d.z);
            };
            Vec3d focus = at_focus(camera.generate_ray(film, pinhole));
            double mean_r2 = 0;
            for (int k = 0; k < 400; ++k) {
                Ray ray = camera.generate_ray(film, uniforms.next_2f());
                EXPECT_NEAR(length(ray.d), 1, 1e-5);
                EXPECT_LT(length(at_focus(ray) - focus), 2e-5);
                Vec3d o = t.point(Vec3d(ray.o));
                EXPECT_NEAR(o.z, 0, 1e-5);
                double r2 = o.x * o.x + o.y * o.y;
                EXPECT_LE(r2, 0.09 * 1.0001);
                mean_r2 += r2 / 400;
            }
            // Uniform on the disk; r^2 has mean R^2 / 2 and standard deviation R^2 / sqrt(12).
            EXPECT_NEAR(mean_r2, 0.045, 6 * 0.09 / std::sqrt(12.0 * 400));
        }
    }
}

// The footprint is the distance on the surface between the rays of neighbouring pixels.
TEST(Camera, FootprintIsTheStepOfAPixel) {
    Transform t = *Transform::look_at({1, 2, 3}, {1, 5, 3}, {0, 0, 1});
    const CameraModel models[] = {PerspectiveCamera{.fov = 20}, OrthographicCamera{}};
    for (const CameraModel& model : models) {
        Camera camera({model, t.inverse()}, 100, 100);
        for (Vec3d normal : {Vec3d{0, -1, 0}, Vec3d{0.3, -1, 0.5}, Vec3d{-1, 0.4, 0.2}}) {
            Vec3d n = normalize(normal);
            const Vec3d on_plane{1, 6, 3};
            auto hit = [&](float x, float y) {
                Ray ray = camera.generate_ray({x, y}, pinhole);
                return Vec3d(ray.o) + Vec3d(ray.d) * (dot(on_plane - Vec3d(ray.o), n) / dot(Vec3d(ray.d), n));
            };
            for (float scale : {1.0f, 0.25f}) {
                Vec3d p = hit(50, 50);
                auto footprint = camera.footprint(Vec3f(p), Vec3f(n), scale);
                Vec3d dx = (hit(50.5f, 50) - hit(49.5f, 50)) * double(scale),
                      dy = (hit(50, 50.5f) - hit(50, 49.5f)) * double(scale);
                EXPECT_NEAR(dot(Vec3d(footprint.dpdx), n), 0, 1e-6);
                EXPECT_NEAR(dot(Vec3d(footprint.dpdy), n), 0, 1e-6);
                EXPECT_NEAR(length(footprint.dpdx) / length(dx), 1, 0.02);
                EXPECT_NEAR(length(footprint.dpdy) / length(dy), 1, 0.02);
                // Along the same lines; the sign does not matter to a filter.
                EXPECT_NEAR(std::abs(dot(normalize(Vec3d(footprint.dpdx)), normalize(dx))), 1, 1e-2);
                EXPECT_NEAR(std::abs(dot(normalize(Vec3d(footprint.dpdy)), normalize(dy))), 1, 1e-2);
            }
        }
    }
}

TEST(Camera, FootprintStaysFinite) {
    Camera camera({PerspectiveCamera{}, {}}, 10, 10);
    auto grazing = camera.footprint({0, 0, 5}, {1, 0, 0}, 1);
    EXPECT_TRUE(is_finite(grazing.dpdx) && is_finite(grazing.dpdy));
    auto at_the_eye = camera.footprint({0, 0, 0}, {0, 0, 1}, 1);
    EXPECT_TRUE(is_finite(at_the_eye.dpdx) && is_finite(at_the_eye.dpdy));
}

TEST(Camera, RefusesInvalidSettings) {
    for (float fov : {0.0f, -5.0f, 180.0f, std::nanf("")})
        EXPECT_THROW(Camera({PerspectiveCamera{.fov = fov}, {}}, 8, 8), Error) << fov;
    EXPECT_THROW(Camera({PerspectiveCamera{.lens_radius = -1}, {}}, 8, 8), Error);
    EXPECT_THROW(Camera({PerspectiveCamera{.lens_radius = std::nanf("")}, {}}, 8, 8), Error);
    EXPECT_THROW(Camera({OrthographicCamera{.lens_radius = 1, .focal_distance = 0}, {}}, 8, 8), Error);
}

} // namespace
} // namespace montelux
