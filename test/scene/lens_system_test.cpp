// Lens systems: focus, focal length, the exit pupil and its weights, and what is no lens.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/scene/camera/aperture_picture.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/camera/lens_system.h"

namespace montelux::testing {
namespace {

// A biconvex lens of glass 1.5 with a stop behind it. If it were thin, 1/f = 2 (n - 1) / r, so f = r = 50 mm; its
// 3 mm of glass add half a millimetre.
RealisticCamera singlet(float stop_radius, float focus_distance) {
    return {
        .surfaces = {{0.05f, 0.003f, 1.5f, 0.01f}, {-0.05f, 0.001f, 1, 0.01f}, {0, 0.05f, 0, stop_radius}},
        .focus_distance = focus_distance,
        .film_diagonal = 0.02f};
}

TEST(LensSystem, FocalLengthOfAThinLens) {
    EXPECT_NEAR(LensSystem(singlet(0.002f, 2)).focal_length(), 0.05, 0.001);
}

// Rays from one film point meet where they are to be in focus; twice as far away they do not.
TEST(LensSystem, IsSharpAtTheFocusDistance) {
    for (const float distance : {0.25f, 0.5f, 1.0f}) {
        const LensSystem lens(singlet(0.0005f, distance));
        for (const Point2f film : {Point2f{0, 0}, Point2f{0.001f, -0.002f}}) {
            const auto spread = [&](float z) {
                double least_x = 1e9, most_x = -1e9;
                for (int i = 0; i < 64; ++i) {
                    const int row = i / 8, column = i % 8;
                    const auto s = lens.sample(film, {(static_cast<float>(column) + 0.5f) / 8,
                                                      (static_cast<float>(row) + 0.5f) / 8});
                    if (!s) continue;
                    const float t = (z - s->ray.o.z) / s->ray.d.z;
                    const double x = static_cast<double>(s->ray.o.x + t * s->ray.d.x);
                    least_x = std::min(least_x, x);
                    most_x = std::max(most_x, x);
                }
                return most_x - least_x;
            };
            // Spherical aberration leaves a small disc.
            EXPECT_LT(spread(distance), 0.05 * spread(2 * distance)) << distance;
            EXPECT_GT(spread(2 * distance), 5e-4) << distance;
        }
    }
}

// The picture is upside down: pixels to the right and above the centre see what is to the right and above.
TEST(LensSystem, CamerasTurnThePictureUpright) {
    CameraSettings settings;
    settings.model = singlet(0.003f, 2);
    const Camera camera(settings, 60, 40);
    EXPECT_TRUE(camera.has_lens());
    const CameraRay right = camera.generate_ray({50, 20}, {0.5f, 0.5f});
    const CameraRay above = camera.generate_ray({30, 5}, {0.5f, 0.5f});
    ASSERT_GT(right.weight, 0);
    ASSERT_GT(above.weight, 0);
    EXPECT_GT(right.d.x, 0.05f);
    EXPECT_NEAR(right.d.y, 0, 0.01);
    EXPECT_GT(above.d.y, 0.05f);
    EXPECT_GT(above.d.z, 0.9f);
}

// Projection by the focal length inverts the rays through the middle of the pupil, but for the extension of the lens: a
// fortieth of the distance from the middle of the film at a focus 40 focal lengths away.
TEST(LensSystem, ProjectionLeadsBackToTheFilm) {
    CameraSettings settings;
    settings.model = singlet(0.003f, 2);
    const Camera camera(settings, 60, 40);
    for (const Point2f film :
         {Point2f{50, 20}, Point2f{15, 20}, Point2f{30, 5}, Point2f{30, 30}, Point2f{45, 10}}) {
        const CameraRay ray = camera.generate_ray(film, {0.5f, 0.5f});
        ASSERT_GT(ray.weight, 0);
        const auto back = camera.project(Vec3d(ray.o) + 100 * Vec3d(ray.d));
        ASSERT_TRUE(back.has_value());
        EXPECT_NEAR(back->x, film.x, 1) << film.x << ' ' << film.y;
        EXPECT_NEAR(back->y, film.y, 1) << film.x << ' ' << film.y;
    }
    EXPECT_FALSE(camera.project({0, 0, -1}).has_value());
}

// Under radiance 1. In the middle of the film pi sin^2(theta) with tan(theta) = radius / distance of the pupil.
TEST(LensSystem, WeightsAreTheIrradianceOfTheExitPupil) {
    for (const float radius : {0.001f, 0.008f}) {
        const LensSystem lens(singlet(radius, 2));
        PhiloxStream random(7);
        for (const float x : {0.0f, 0.004f, 0.009f}) {
            double sum = 0, squares = 0;
            constexpr int n = 200000;
            for (int i = 0; i < n; ++i) {
                const auto s = lens.sample({x, 0}, random.next_2d());
                const double w = s ? static_cast<double>(s->weight) : 0;
                sum += w;
                squares += w * w;
            }
            const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
            // The stop is the last surface, so the pupil is the stop itself, seen at an angle: integrated over its
            // disc by a grid.
            const double z = static_cast<double>(lens.rear_z());
            double truth = 0;
            constexpr int grid = 400;
            for (int j = 0; j < grid; ++j)
                for (int i = 0; i < grid; ++i) {
                    const double r = static_cast<double>(radius), px = r * ((i + 0.5) / grid * 2 - 1),
                                 py = r * ((j + 0.5) / grid * 2 - 1);
                    if (px * px + py * py > r * r) continue;
                    const double d2 = (px - double(x)) * (px - double(x)) + py * py + z * z;
                    truth += z * z / (d2 * d2) * 4 * r * r / (grid * grid);
                }
            EXPECT_NEAR(mean, truth, 5 * error + 2e-3 * truth) << radius << " " << x;
            if (x == 0) {
                const double r2 = double(radius) * double(radius);
                EXPECT_NEAR(truth, pi * r2 / (z * z + r2), 5e-3 * truth);
            }
        }
    }
}

// With the stop in front of the lens the pupil of a film point lies beside the axis, towards the point; nothing changes
// where both turn about the axis.
TEST(LensSystem, WeightsDependOnTheDistanceFromTheAxisAlone) {
    const LensSystem lens(RealisticCamera{
        .surfaces = {{0, 0.02f, 0, 0.004f}, {0.05f, 0.003f, 1.5f, 0.01f}, {-0.05f, 0.05f, 1, 0.01f}},
        .focus_distance = 2,
        .film_diagonal = 0.02f});
    struct Weight {
        double mean = 0, error = 0;
    };
    const auto weight_at = [&](Point2f film) {
        PhiloxStream random(7);
        double sum = 0, squares = 0;
        constexpr int n = 100000;
        for (int i = 0; i < n; ++i) {
            const auto s = lens.sample(film, random.next_2d());
            const double w = s ? static_cast<double>(s->weight) : 0;
            sum += w;
            squares += w * w;
        }
        const double mean = sum / n;
        return Weight{mean, std::sqrt((squares / n - mean * mean) / n)};
    };
    const Weight right = weight_at({0.008f, 0});
    EXPECT_GT(right.mean, 20 * right.error);
    for (const Point2f film :
         {Point2f{0, 0.008f}, Point2f{0, -0.008f}, Point2f{-0.008f, 0}, Point2f{-0.0048f, 0.0064f}}) {
        const Weight other = weight_at(film);
        EXPECT_NEAR(other.mean, right.mean, 5 * std::hypot(other.error, right.error))
            << film.x << ' ' << film.y;
    }
}

// Backwards: a ray that left the lens, sent back along its path, arrives at the film point.
TEST(LensSystem, LightGoesBothWays) {
    const LensSystem lens(singlet(0.005f, 1));
    PhiloxStream random(9);
    int passed = 0;
    for (int i = 0; i < 1000; ++i) {
        const Point2f film{0.005f * random.next_1d(), 0.005f * random.next_1d()};
        const auto s = lens.sample(film, random.next_2d());
        if (!s) continue;
        const auto back = lens.trace_from_scene({s->ray.o + s->ray.d, -s->ray.d});
        ASSERT_TRUE(back.has_value());
        const float t = -back->o.z / back->d.z;
        EXPECT_NEAR(back->o.x + t * back->d.x, film.x, 2e-6);
        EXPECT_NEAR(back->o.y + t * back->d.y, film.y, 2e-6);
        ++passed;
    }
    EXPECT_GT(passed, 300);
}

TEST(LensSystem, RefusesWhatIsNoLens) {
    EXPECT_THROW(LensSystem(RealisticCamera{}), Error);
    EXPECT_THROW(LensSystem(singlet(0, 2)), Error);
    EXPECT_THROW(LensSystem(singlet(0.002f, 0.1f)), Error); // nearer than four focal lengths
    RealisticCamera diverging = singlet(0.002f, 2);
    diverging.surfaces[0].radius = -0.05f;
    diverging.surfaces[1].radius = 0.05f;
    EXPECT_THROW(LensSystem{diverging}, Error);
    RealisticCamera plane = singlet(0.002f, 2);
    plane.surfaces = {plane.surfaces[2]};
    EXPECT_THROW(LensSystem{plane}, Error);
}

// Each built-in picture has the mean of the disc, and its shape: by its second moments and the symmetry of its edge.
TEST(AperturePicture, ShapesAreDrawn) {
    EXPECT_FALSE(find_aperture("hexagon"));
    for (const std::string_view name : aperture_names()) {
        const AperturePicture p = *find_aperture(name);
        double sum = 0;
        for (const float v : p.values) sum += static_cast<double>(v);
        EXPECT_NEAR(sum / static_cast<double>(p.values.size()), pi / 4, 1e-5) << name;
        EXPECT_GT(p.at(0, 0), 0) << name;
        EXPECT_EQ(p.at(1.01, 0), 0) << name;
    }
    const AperturePicture square = *find_aperture("square"), pentagon = *find_aperture("pentagon"),
                          star = *find_aperture("star"), gaussian = *find_aperture("gaussian");
    EXPECT_NEAR(square.at(0.4, -0.4), pi, 1e-5); // a quarter of the picture
    EXPECT_EQ(square.at(0.6, 0), 0);
    EXPECT_GT(pentagon.at(0, 0.75), 0); // its corner is up, its edge down at 0.8 cos 36
    EXPECT_GT(pentagon.at(0, -0.63), 0);
    EXPECT_EQ(pentagon.at(0, -0.67), 0);
    // Area of the regular pentagon of radius 0.8: 5/2 r^2 sin 72 degrees.
    EXPECT_NEAR(pentagon.at(0, 0), pi / (2.5 * 0.64 * std::sin(2 * pi / 5)), 1e-3);
    EXPECT_GT(star.at(-0.95, 0), 0); // a point of the star is at the left, a notch at the right
    EXPECT_EQ(star.at(0.5, 0), 0);
    EXPECT_GT(star.at(0.36, 0), 0);
    EXPECT_NEAR(gaussian.at(0.5, 0) / gaussian.at(0, 0),
                (std::exp(-0.25) - std::exp(-1.0)) / (1 - std::exp(-1.0)), 1e-3);
}

// Half of the code values of sRGB is a fifth of the light.
TEST(AperturePicture, PicturesAreLinear) {
    Image encoded(2, 1, {"Y"}, PixelFormat::u8, ColorEncoding::srgb());
    encoded.u8()[0] = 128;
    encoded.u8()[1] = 255;
    const AperturePicture p = aperture_of(encoded);
    EXPECT_NEAR(p.values[0] / p.values[1], 0.2158605, 1e-6);
}

// On the axis the mean weight, irradiance of a white scene, is that of the round stop for any picture, up to the cosines
// across the pupil; rays that pass lie in the picture's shape at the stop, the last surface here.
TEST(LensSystem, PicturesShapeTheStop) {
    const auto mean_weight = [](const RealisticCamera& camera, double& largest_x) {
        const LensSystem lens(camera);
        PhiloxStream stream(7);
        double sum = 0;
        largest_x = 0;
        constexpr int n = 200000;
        for (int i = 0; i < n; ++i) {
            const Vec2f u = stream.next_2d();
            const auto s = lens.sample({0, 0}, u);
            if (!s) continue;
            sum += static_cast<double>(s->weight);
            largest_x = std::max(largest_x, std::abs(static_cast<double>(s->ray.o.x)));
        }
        return sum / n;
    };
    RealisticCamera camera = singlet(0.002f, 2);
    double round_x = 0, square_x = 0;
    const double round = mean_weight(camera, round_x);
    for (const char* name : {"gaussian", "square", "pentagon", "star"}) {
        camera.aperture = find_aperture(name);
        double x = 0;
        EXPECT_NEAR(mean_weight(camera, x) / round, 1, 0.03) << name;
        if (name == std::string("square")) square_x = x;
    }
    EXPECT_NEAR(square_x / round_x, 0.5, 0.03);
    // A picture in a corner of the square, outside the disc, lets light through all the same, but for the part of its pixel
    // that is blurred over the border.
    AperturePicture corner{8, 8, std::vector<float>(64)};
    corner.values[0] = 64 * pi_f / 4;
    camera.aperture = corner;
    double x = 0;
    EXPECT_NEAR(mean_weight(camera, x) / round, 49.0 / 64, 0.03);
    // It is the upper left corner, for film points on all sides.
    const LensSystem lens(camera);
    PhiloxStream stream(8);
    int passed = 0;
    for (int i = 0; i < 4000; ++i) {
        const float angle = 2 * pi_f * stream.next_1d();
        const auto s = lens.sample({0.003f * std::cos(angle), 0.003f * std::sin(angle)}, stream.next_2d());
        if (!s) continue;
        EXPECT_LT(s->ray.o.x, 0);
        EXPECT_GT(s->ray.o.y, 0);
        ++passed;
    }
    EXPECT_GT(passed, 20);
}

} // namespace
} // namespace montelux::testing
