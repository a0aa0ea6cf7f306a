// The camera as methods that trace light see it: densities of rays against differences of generate_ray, and the way
// back from points of the scene to the film. Nothing here is random.
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/mc/math/constants.h"
#include "montelux/scene/camera/camera.h"

namespace montelux {
namespace {

constexpr int film_width = 60, film_height = 40;

struct CameraCase {
    std::string name;
    Camera camera;
};

std::vector<CameraCase> cameras() {
    const Transform placed = *Transform::look_at({1, 2, 3}, {4, 6, 3.5}, {0, 0, 1});
    const Transform stretched =
        placed.inverse() * Transform::scale({1.5, 0.7, 2}) * Transform::rotate(20, {1, 1, 0});
    const Transform mirrored = Transform::translate({0, 0, -7}) * Transform::scale({-3, 3, 3});
    const PerspectiveCamera lens{.fov = 50, .lens_radius = 0.3f, .focal_distance = 2.5f};
    const OrthographicCamera wide{.lens_radius = 0.2f, .focal_distance = 3};
    return {{"pinhole", Camera({PerspectiveCamera{.fov = 70}, placed.inverse()}, film_width, film_height)},
            {"stretched pinhole", Camera({PerspectiveCamera{.fov = 40}, stretched}, film_width, film_height)},
            {"thin lens", Camera({lens, mirrored}, film_width, film_height)},
            {"stretched lens", Camera({lens, stretched}, film_width, film_height)},
            {"orthographic", Camera({OrthographicCamera{}, mirrored}, film_width, film_height)},
            {"stretched orthographic", Camera({OrthographicCamera{}, stretched}, film_width, film_height)},
            {"orthographic with a lens", Camera({wide, stretched}, film_width, film_height)}};
}

const std::vector<Vec2f> lenses{{0.5f, 0.5f}, {0.1f, 0.7f}, {0.93f, 0.22f}};
const std::vector<Vec2f> films{{30, 20}, {0.3f, 0.7f}, {59, 39.5f}, {17.25f, 33}, {-4, 44}};

// Where the ray meets the plane through `at` across `axis`.
Vec3d on_plane(const Ray& ray, Vec3d at, Vec3d axis) {
    const Vec3d o(ray.o), d(ray.d);
    return o + d * (dot(at - o, axis) / dot(d, axis));
}

// One square pixel of the film at a time spreads over 1 / density across the rays.
TEST(CameraImportance, DensityIsThatOfGeneratedRays) {
    for (const CameraCase& c : cameras())
        for (const Vec2f lens : lenses)
            for (const Vec2f film : films)
                for (const float distance : {0.5f, 20.0f}) {
                    const Ray ray = c.camera.generate_ray(film, lens);
                    const Vec3d axis(ray.d), at = Vec3d(ray.o) + axis * double(distance);
                    constexpr float h = 0.25f;
                    const auto moved = [&](float x, float y) {
                        return on_plane(c.camera.generate_ray({film.x + x, film.y + y}, lens), at, axis);
                    };
                    const Vec3d dx = (moved(h, 0) - moved(-h, 0)) / (2 * double(h));
                    const Vec3d dy = (moved(0, h) - moved(0, -h)) / (2 * double(h));
                    const double area = length(cross(dx, dy));
                    EXPECT_NEAR(double(c.camera.density(ray.d, distance, 0)) * area, 1, 2e-3)
                        << c.name << " film " << film.x << ' ' << film.y << " distance " << distance;
                }
}

TEST(CameraImportance, PointsOfRaysReturnToTheirFilmPoint) {
    for (const CameraCase& c : cameras())
        for (const Vec2f lens : lenses)
            for (const Vec2f film : films)
                for (const float distance : {0.5f, 20.0f}) {
                    const Ray ray = c.camera.generate_ray(film, lens);
                    const auto back = c.camera.sample_wi(ray.o + ray.d * distance, lens, 0);
                    ASSERT_TRUE(back) << c.name;
                    EXPECT_NEAR(back->film.x, film.x, 2e-3) << c.name;
                    EXPECT_NEAR(back->film.y, film.y, 2e-3) << c.name;
                    EXPECT_LT(length(back->lens - ray.o), 1e-4) << c.name;
                    EXPECT_LT(length(back->wi + ray.d), 1e-5) << c.name;
                    EXPECT_NEAR(back->density / c.camera.density(ray.d, distance, 0), 1, 1e-3) << c.name;
                }
}

// The directions that the film covers have the mass of its pixels.
TEST(CameraImportance, IntegratesToTheNumberOfPixels) {
    for (const CameraCase& c : cameras()) {
        if (c.name.find("ortho") != std::string::npos) continue;
        const Vec2f lens{0.3f, 0.8f};
        const Point3f ray_origin = c.camera.generate_ray({30, 20}, lens).o;
        double mass = 0;
        constexpr int rows = 800, columns = 1600;
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const double z = 1 - (i + 0.5) * 2 / rows, phi = (j + 0.5) * 2 * pi / columns;
                const double r = std::sqrt(1 - z * z);
                const Vec3f d(Vec3d{r * std::cos(phi), r * std::sin(phi), z});
                const auto seen = c.camera.sample_wi(ray_origin + d, lens, 0);
                if (!seen || seen->film.x < 0 || seen->film.x >= film_width || seen->film.y < 0 ||
                    seen->film.y >= film_height)
                    continue;
                mass += double(c.camera.pdf_we(d, 0));
            }
        mass *= 4 * pi / (double(rows) * columns);
        EXPECT_NEAR(mass / (film_width * film_height), 1, 0.01) << c.name;
    }
}

TEST(CameraImportance, NothingBehindTheCameraIsSeen) {
    for (const CameraCase& c : cameras()) {
        const Ray ray = c.camera.generate_ray({30, 20}, {0.5f, 0.5f});
        EXPECT_FALSE(c.camera.sample_wi(ray.o - ray.d, {0.5f, 0.5f}, 0)) << c.name;
        if (c.name.find("ortho") == std::string::npos || c.name.find("lens") != std::string::npos) {
            EXPECT_EQ(c.camera.pdf_we(-ray.d, 0), 0) << c.name;
        }
        EXPECT_TRUE(c.camera.has_importance());
    }
    EXPECT_FALSE(Camera({SphericalCamera{}, {}}, 64, 64).has_importance());
}

// At each time the camera stands where generate_ray has it.
TEST(CameraImportance, MovesWithTheCamera) {
    const Transform a = Transform::translate({0, 0, -3}),
                    b = Transform::translate({2, 1, -4}) * Transform::rotate(30, {0, 1, 0});
    CameraSettings settings{PerspectiveCamera{.fov = 60}, a};
    settings.motion = Motion(a, b);
    const Camera camera(settings, film_width, film_height);
    for (const float time : {0.0f, 0.4f, 1.0f}) {
        const Ray ray = camera.generate_ray({12, 31}, {0.5f, 0.5f}, time);
        const auto back = camera.sample_wi(ray.o + 3 * ray.d, {0.5f, 0.5f}, time);
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->film.x, 12, 1e-3);
        EXPECT_NEAR(back->film.y, 31, 1e-3);
        EXPECT_NEAR(back->density / camera.density(ray.d, 3, time), 1, 1e-4);
    }
}

} // namespace
} // namespace montelux
