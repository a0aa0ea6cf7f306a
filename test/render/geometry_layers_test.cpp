// Layers of geometry, of motion and of coverage have known values.
#include "test/render/layer_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/warp/disk.h"
#include "montelux/render/sample_record.h"
#include "montelux/scene/camera/camera.h"

namespace montelux::testing {
namespace {

TEST(Layers, GeometryHasKnownValues) {
    SceneBuilder b = square_below();
    const Transform start = b.scene.camera.world_from_camera;
    // Pixels are 4/16 wide at the square: two pixels of motion.
    b.scene.camera.motion.emplace(start, start * Transform::translate({0.5, 0, 0}));
    b.scene.camera.shutter_close = 0.5f; // the first half of it
    const Image image = render_state(b.description).film.develop();
    for (int y = 5; y < 11; ++y)
        for (int x = 5; x < 11; ++x) {
            EXPECT_FLOAT_EQ(value_of(image, x, y, "A"), 1);
            EXPECT_FLOAT_EQ(value_of(image, x, y, "Ng.Z"), 1);
            EXPECT_NEAR(value_of(image, x, y, "P.Z"), 0, 1e-6);
            // Camera coordinates grow to the right, world x in the opposite direction or not: by the matrix.
            const Vec3d middle = start.point(Vec3d{(x + 0.5 - 8) / 4 + 0.125, (8 - y - 0.5) / 4, 4});
            EXPECT_NEAR(value_of(image, x, y, "P.X"), middle.x, 0.06);
            EXPECT_NEAR(value_of(image, x, y, "P.Y"), middle.y, 0.05);
            EXPECT_NEAR(value_of(image, x, y, "uv.U"), (value_of(image, x, y, "P.X") + 1) / 2, 1e-5);
            EXPECT_NEAR(value_of(image, x, y, "uv.V"), (value_of(image, x, y, "P.Y") + 1) / 2, 1e-5);
            EXPECT_NEAR(value_of(image, x, y, "motion.X"), -1, 1e-4);
            EXPECT_NEAR(value_of(image, x, y, "motion.Y"), 0, 1e-4);
            EXPECT_NEAR(value_of(image, x, y, "dzdx"), 0, 1e-5);
        }
    EXPECT_EQ(value_of(image, 0, 0, "A"), 0);
    EXPECT_EQ(value_of(image, 0, 0, "P.X"), 0);
    EXPECT_EQ(value_of(image, 0, 0, "CryptoShape00.R"), 0);
}

TEST(Layers, CoordinatesMayBeThoseOfTheCamera) {
    SceneBuilder b = square_below();
    // Turned about x: z grows by tan(30 degrees) per unit of y in the middle of the picture.
    b.scene.meshes[0] = square(Transform::rotate(30, {1, 0, 0}));
    b.description.film.layers.in_camera_space = true;
    b.description.film.layers.set.add(Layer::normal);
    const Image image = render_state(b.description).film.develop();
    const Transform camera_from_world = b.scene.camera.world_from_camera.inverse();
    const Vec3d n = camera_from_world.vector(Vec3d{0, -0.5, std::sqrt(0.75)});
    for (const char* layer : {"Ng.", "N."})
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(value_of(image, 8, 8, (layer + std::string(1, "XYZ"[c])).c_str()), n[c], 1e-5)
                << layer << c;
    EXPECT_NEAR(value_of(image, 8, 8, "P.Z"), 4, 0.2);
    // z = 4 / (1 + k t) along rays of slope t, which is 1/16 per row, upwards.
    const double k = n.y / n.z, t = -0.5 / 16, slope = k / 4 / std::pow(1 + k * t, 2);
    EXPECT_NEAR(value_of(image, 8, 8, "dzdy"), slope, 0.02 * std::abs(slope));
    EXPECT_NEAR(value_of(image, 8, 8, "dzdx"), 0, 1e-4);
}

// A camera that turns and moves: coordinates are those of its place at the time of each sample.
TEST(Layers, CoordinatesOfTheCameraAreThoseOfTheSample) {
    SceneBuilder b = square_below();
    TriangleMesh floor = square(Transform::scale({9, 9, 1}));
    floor.normals.assign(4, normalize(Normal3f{0.3f, 0.2f, 1}));
    b.scene.meshes[0] = floor;
    const Transform start = b.scene.camera.world_from_camera;
    b.scene.camera.motion.emplace(start, Transform::translate({0.2, 0.1, 1}) * start *
                                             Transform::rotate(50, {0.2, 0.1, 1}));
    b.description.film.layers.set = {Layer::position, Layer::geometric_normal, Layer::normal};
    b.description.sampler.spp = 1;
    const Image world = render_state(b.description).film.develop();
    b.description.film.layers.in_camera_space = true;
    const Image seen = render_state(b.description).film.develop();
    const Renderer renderer(b.description);
    const Camera camera(b.scene.camera, 16, 16);
    const auto triple = [](const Image& image, int x, int y, const std::string& layer) {
        const auto part = [&](const char* letter) {
            return static_cast<double>(value_of(image, x, y, (layer + letter).c_str()));
        };
        return Vec3d{part(".X"), part(".Y"), part(".Z")};
    };
    for (int x = 0; x < 16; ++x) {
        const Transform from_world = camera.camera_from_world(renderer.replay(x, 5, 0).time);
        const Vec3d p = from_world.point(triple(world, x, 5, "P"));
        EXPECT_LT(length(triple(seen, x, 5, "P") - p), 1e-5);
        EXPECT_LT(length(triple(world, x, 5, "Ng") - Vec3d{0, 0, 1}), 1e-6);
        for (const char* layer : {"Ng", "N"}) {
            const Vec3d n = from_world.vector(triple(world, x, 5, layer));
            EXPECT_LT(length(triple(seen, x, 5, layer) - n), 2e-4) << layer; // turns are made of chords
        }
        EXPECT_GT(length(triple(world, x, 5, "N") - Vec3d{0, 0, 1}), 0.1);
    }
}

// Of a plane z = d + a x + c y of camera space, seen along (s, t, 1) from the point (u, v, 0) of the lens focused at f:
// s = (x - u) / f for the point x in focus. The camera turns and moves away while the shutter is open.
TEST(Layers, DepthSlopesAreThoseOfTheSample) {
    for (const float lens_radius : {0.0f, 0.4f}) {
        SceneBuilder b = square_below();
        // Turned about x and y; 40 wide.
        const Transform turned = Transform::rotate(30, {1, 0, 0}) * Transform::rotate(20, {0, 1, 0});
        b.scene.meshes[0] = square(turned * Transform::scale({20, 20, 1}));
        auto& model = std::get<PerspectiveCamera>(b.scene.camera.model);
        model.lens_radius = lens_radius;
        model.focal_distance = 4;
        const Transform start = b.scene.camera.world_from_camera;
        b.scene.camera.motion.emplace(start, Transform::translate({0, 0, 2}) * start *
                                                 Transform::rotate(10, {1, 0.5, 0}));
        b.description.film.layers.set = {Layer::depth_slopes};
        b.description.sampler.spp = 1;
        const Image image = render_state(b.description).film.develop();
        const Renderer renderer(b.description);
        const Camera camera(b.scene.camera, 16, 16);
        for (int x = 1; x < 16; x += 3)
            for (int y = 1; y < 16; y += 3) {
                const SampleRecord r = renderer.replay(x, y, 0);
                const Transform from_world = camera.camera_from_world(r.time);
                const Vec3d n = from_world.normal(turned.vector(Vec3d{0, 0, 1})),
                            p = from_world.point(Vec3d{});
                const double a = -n.x / n.z, c = -n.y / n.z, d = p.z - a * p.x - c * p.y;
                EXPECT_GT(std::min(std::abs(a), std::abs(c)), 0.1);
                const Vec2f on_lens = sample_uniform_disk_concentric(r.lens) * lens_radius;
                const double u = double(on_lens.x), v = double(on_lens.y);
                const auto depth = [&](double film_x, double film_y) {
                    const double s = (film_x - 8) / 16 - u / 4, t = (8 - film_y) / 16 - v / 4;
                    return (d + a * u + c * v) / (1 - a * s - c * t);
                };
                const double fx = double(r.film.x), fy = double(r.film.y);
                const double dx = depth(fx + 0.5, fy) - depth(fx - 0.5, fy),
                             dy = depth(fx, fy + 0.5) - depth(fx, fy - 0.5);
                EXPECT_NEAR(value_of(image, x, y, "dzdx"), dx, 1e-3 * std::abs(dx)) << lens_radius;
                EXPECT_NEAR(value_of(image, x, y, "dzdy"), dy, 1e-3 * std::abs(dy)) << lens_radius;
            }
    }
}

// A moving instance, at all times of its samples.
TEST(Layers, MotionFollowsInstances) {
    SceneBuilder b = square_below();
    CallMessages messages("scene of a test");
    montelux::SceneBuilder builder(b.scene, messages);
    builder.begin_object("card");
    builder.add_shape(square(Transform::scale({3, 3, 1})), {.material = 0});
    builder.end_object();
    // One unit to the right in the camera's eyes and half a unit down, at distance 2: a pixel is 1/8 wide.
    const Transform& camera = b.scene.camera.world_from_camera;
    const Vec3d step = camera.vector(Vec3d{1, -0.5, 0});
    builder.add_instance("card", Transform::translate({0, 0, 2}),
                         Transform::translate(Vec3d{0, 0, 2} + step));
    builder.finish();
    const Image image = render_state(b.description).film.develop();
    for (int i = 2; i < 14; ++i) {
        EXPECT_NEAR(value_of(image, i, 8, "motion.X"), 8, 1e-3);
        EXPECT_NEAR(value_of(image, i, 8, "motion.Y"), 4, 1e-3);
    }
}

// A card that grows to twice its size: its points move away from the middle, whichever the time they are seen at.
TEST(Layers, MotionFollowsMeshesThatDeform) {
    for (const bool in_instance : {false, true}) {
        SceneBuilder b = square_below();
        CallMessages messages("scene of a test");
        montelux::SceneBuilder builder(b.scene, messages);
        const Transform place = Transform::translate({0, 0, 2});
        TriangleMesh card = square(in_instance ? Transform() : place);
        card.end_positions = card.positions;
        for (Point3f& p : card.positions) p = {1.5f * p.x, 1.5f * p.y, p.z};
        for (Point3f& p : card.end_positions) p = {3 * p.x, 3 * p.y, p.z};
        if (in_instance) builder.begin_object("card");
        builder.add_shape(std::move(card), {.material = 0});
        builder.end_object();
        // By 8 pixels to the right while it grows: a pixel is 1/8 wide.
        const Vec3d step = b.scene.camera.world_from_camera.vector(Vec3d{1, 0, 0});
        if (in_instance) builder.add_instance("card", place, Transform::translate(step) * place);
        builder.finish();
        b.description.film.layers.in_camera_space = true;
        b.description.sampler.spp = 1;
        const Film film = render_state(b.description).film;
        const Image image = film.develop();
        const Renderer renderer(b.description);
        for (int x = 2; x < 14; ++x) {
            const SampleRecord r = renderer.replay(x, 8, 0);
            // The camera is 2 above it. A point at distance d from the middle of the card was at d / (1 + t).
            const double d = value_of(image, x, 8, "P.X") - (in_instance ? double(r.time) : 0);
            const double grown = d / (1 + double(r.time));
            EXPECT_NEAR(value_of(image, x, 8, "motion.X"), 8 * (grown + (in_instance ? 1 : 0)), 2e-3)
                << x << " " << in_instance;
        }
    }
}

// Projection is the inverse of the camera's rays.
TEST(Layers, ProjectionInvertsTheCamera) {
    const auto expect_inverse = [](const CameraModel& model, double tolerance) {
        CameraSettings settings;
        settings.model = model;
        settings.world_from_camera = Transform::translate({1, 2, 3}) * Transform::rotate(40, {1, 2, 0});
        const Camera camera(settings, 32, 24);
        for (float y = 1.25f; y < 24; y += 3.5f)
            for (float x = 1.75f; x < 32; x += 4.5f) {
                const CameraRay ray = camera.generate_ray({x, y}, {0.5f, 0.5f});
                const auto film =
                    camera.project(camera.camera_from_world(0).point(Vec3d(ray.o) + Vec3d(ray.d) * 7));
                ASSERT_TRUE(film);
                EXPECT_NEAR(film->x, x, tolerance);
                EXPECT_NEAR(film->y, y, tolerance);
            }
    };
    expect_inverse(PerspectiveCamera{.fov = 70}, 1e-4);
    expect_inverse(PerspectiveCamera{.fov = 70, .screen_window = ScreenWindow{-0.2f, 1, -1, 0.5f}}, 1e-4);
    expect_inverse(OrthographicCamera{}, 1e-4);
    expect_inverse(SphericalCamera{SphericalCamera::Mapping::equirectangular}, 1e-3);
    expect_inverse(SphericalCamera{SphericalCamera::Mapping::equal_area}, 1e-3);
    CameraSettings sphere;
    sphere.model = SphericalCamera{SphericalCamera::Mapping::equirectangular};
    const Camera around(sphere, 100, 50);
    EXPECT_NEAR(around.film_step({98, 10}, {3, 12}).x, 5, 1e-4);
    EXPECT_FALSE(Camera({}, 8, 8).project({0, 0, -1}));
}

// Transparency of a medium that only absorbs, over nothing.
TEST(Layers, AlphaIsTheShareOfLightThatIsStopped) {
    SceneBuilder b;
    b.add_uniform_light(1);
    b.scene.media.emplace_back(HomogeneousMedium{});
    auto& smoke = std::get<HomogeneousMedium>(b.scene.media.back());
    smoke.sigma_a = {0.5f};
    smoke.sigma_s = {0};
    Index glass = b.add(InterfaceMaterial{});
    b.add_quadric(Sphere{.world_from_object = Transform()}, glass);
    b.scene.shapes[0].media = {0, no_index};
    b.look({0, 0, 4}, {0, 0, 0}, 1);
    b.description.film.layers.set = {Layer::alpha};
    const Image image = render_state(b.description).film.develop();
    EXPECT_NEAR(value_of(image, 4, 4, "A"), 1 - std::exp(-1.0), 1e-3); // 2 units of it
}

} // namespace
} // namespace montelux::testing
