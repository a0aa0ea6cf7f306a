// Lens systems: focus, focal length, the exit pupil and its weights, and what is no lens.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/philox_stream.h"
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

} // namespace
} // namespace montelux::testing
