// Motion blur: closed forms, the mean of pictures that stand still, and the same bits on any path of the code.
// Each comparison of means is at 5 standard errors.
#include "test/render/motion_testing.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/render/sample_record.h"

namespace montelux::testing {
namespace {

// A white sky behind a black square of side 2, which moves to the right by `way`. Orthographic, 16 x 1 pixels
// over [-4, 4].
SceneBuilder passing_square(double way) {
    SceneBuilder b;
    b.description.film.width = 16;
    b.description.film.height = 1;
    b.description.film.crop = {0, 0, 16, 1};
    b.description.sampler.spp = 1024;
    b.scene.camera.model = OrthographicCamera{.screen_window = ScreenWindow{-4, 4, -0.25f, 0.25f}};
    b.scene.camera.world_from_camera = Transform::translate({0, 0, -5});
    b.add_uniform_light(1);
    b.add_mesh(square(Transform()), b.add(DiffuseMaterial{gray(0)}));
    b.scene.world_shapes.clear();
    b.scene.objects.push_back({.shapes = {0}});
    b.scene.motions.emplace_back(Transform::translate({-way / 2, 0, 0}),
                                 Transform::translate({way / 2, 0, 0}));
    b.scene.instances.push_back({0, b.scene.motions[0].start(), 0});
    return b;
}

// The share of the exposure [from, to] (times of the motion) during which the square does not cover x.
double uncovered(double x, double way, double from, double to) {
    // It covers x while |x - centre| < 1, where centre = way * (t - 1/2).
    const double begin = (x - 1) / way + 0.5, end = (x + 1) / way + 0.5;
    return 1 - std::max(0.0, std::min(end, to) - std::max(begin, from)) / (to - from);
}

// The picture of 16 pixels over -4, ..., 4 with every sampler; truth(x, open, close) is radiance on the film.
template <typename Truth>
void expect_blur(SceneBuilder b, std::initializer_list<std::pair<float, float>> shutters,
                 const Truth& truth) {
    for (const SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol, SamplerKind::halton})
        for (const auto& [open, close] : shutters) {
            b.description.sampler.kind = sampler;
            b.scene.camera.shutter_open = open;
            b.scene.camera.shutter_close = close;
            const Film film = render(b.description);
            for (int x = 0; x < 16; ++x) {
                double mean = 0; // over the pixel
                for (int i = 0; i < 1000; ++i)
                    mean += truth(-4 + (x + (i + 0.5) / 1000) * 0.5, double(open), double(close)) / 1000;
                const auto& pixel = film.pixel(x, 0).replicates();
                EXPECT_NEAR(pixel.mean(1), mean, 5 * std::sqrt(pixel.variance_of_mean(1)) + 2e-3)
                    << x << " " << open;
            }
        }
}

TEST(MotionBlur, ASquareBlursToATrapezoid) {
    constexpr double way = 3;
    expect_blur(passing_square(way), {{0.0f, 1.0f}, {0.25f, 0.5f}},
                [](double x, double open, double close) { return uncovered(x, way, open, close); });
}

// Before the motion's time it stands at its start, after it at its end.
TEST(MotionBlur, StandsStillOutsideOfItsTime) {
    SceneBuilder b = passing_square(4);
    b.scene.camera.shutter_open = 2;
    b.scene.camera.shutter_close = 5;
    const Film film = render(b.description);
    for (int x = 0; x < 16; ++x)
        EXPECT_NEAR(film.pixel(x, 0).replicates().mean(1), x >= 10 && x < 14 ? 0 : 1, 0.15) << x;
}

// A lamp over a floor, and a tumbling diffuse box between them that casts a moving shadow.
SceneBuilder tumbling_box() {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 12;
    b.description.film.crop = {0, 0, 12, 12};
    b.add_mesh(square(Transform::scale({4, 4, 1})), b.add(DiffuseMaterial{gray(0.7f)}));
    b.add_mesh(square(Transform::translate({0, 0, 4}) * Transform::rotate(180, {1, 0, 0})),
               b.add(DiffuseMaterial{gray(0)}), 5);
    const auto first = static_cast<Index>(b.scene.shapes.size());
    const Index paint = b.add(DiffuseMaterial{gray(0.4f)});
    b.add_mesh(square(Transform::scale({1, 0.5, 1})), paint);
    b.add_quadric(Sphere{.radius = 0.4f, .z_min = -0.4f, .z_max = 0.4f, .world_from_object = {}}, paint);
    b.scene.world_shapes = {0, 1};
    b.scene.objects.push_back({.shapes = {first, first + 1}});
    b.scene.motions.emplace_back(Transform::translate({-1, 0, 1}),
                                 Transform::translate({1, 0.5, 1.5}) * Transform::rotate(120, {1, 2, 0}));
    b.scene.instances.push_back({0, b.scene.motions[0].start(), 0});
    b.look({0, -7, 5}, {0, 0, 0.7}, 45);
    return b;
}

TEST(MotionBlur, IsTheMeanOfPicturesThatStandStill) {
    SceneBuilder b = tumbling_box();
    b.description.sampler.spp = 2048;
    expect_mean_of_frames(b.description, [&](float t) {
        SceneDescription d = b.description;
        d.sampler.spp = 64;
        d.scene.instances[0] = {0, d.scene.motions[0].at(t)};
        d.scene.motions.clear();
        return d;
    });
}

TEST(MotionBlur, OfTheCameraIsTheMeanOfPicturesThatStandStill) {
    SceneBuilder b = tumbling_box();
    b.description.sampler.spp = 2048;
    b.scene.motions.clear();
    b.scene.instances[0].motion = no_index;
    const Transform start = b.scene.camera.world_from_camera;
    b.scene.camera.motion.emplace(start, Transform::translate({0.5, 0, 0.2}) * start *
                                             Transform::rotate(10, {0, 0, 1}));
    expect_mean_of_frames(b.description, [&](float t) {
        SceneDescription d = b.description;
        d.sampler.spp = 64;
        d.scene.camera.world_from_camera = d.scene.camera.motion->at(t);
        d.scene.camera.motion.reset();
        return d;
    });
}

// A lamp over a floor, and an object that is used once as it is and once mirrored: a still square, and a
// square and a sphere that move. The second use moves, too.
struct TurningArms {
    static constexpr int uses = 2;
    static Transform arm(double t) {
        return Transform::translate({0.9 - 1.2 * t, 0.7 * t, 0}) * Transform::rotate(100 * t, {0, 0.2, 1});
    }
    static Transform use(int i, double t) {
        if (i == 0) return Transform::translate({-1.2, 0, 1});
        return Transform::translate({1.2 - 0.5 * t, 0.5, 1.4}) * Transform::rotate(-70 * t, {1, 0, 0}) *
               Transform::scale({-0.8, 0.8, 1.1});
    }
    static SceneBuilder lamp_and_floor() {
        SceneBuilder b;
        b.description.film.width = b.description.film.height = 12;
        b.description.film.crop = {0, 0, 12, 12};
        b.add_mesh(square(Transform::scale({4, 4, 1})), b.add(DiffuseMaterial{gray(0.7f)}));
        b.add_mesh(square(Transform::translate({0, 0, 4}) * Transform::rotate(180, {1, 0, 0})),
                   b.add(DiffuseMaterial{gray(0)}), 5);
        b.add(DiffuseMaterial{gray(0.4f)});
        b.look({0, -7, 5}, {0, 0, 0.7}, 45);
        return b;
    }
    static TriangleMesh card() { return square(Transform::scale({0.5, 0.3, 1})); }
    static Quadric ball() {
        return Sphere{.radius = 0.4f, .z_min = -0.4f, .z_max = 0.4f, .world_from_object = {}};
    }
    static SceneBuilder moving() {
        SceneBuilder b = lamp_and_floor();
        CallMessages messages("scene of a test");
        montelux::SceneBuilder builder(b.scene, messages);
        builder.begin_object("arm");
        builder.add_shape(card(), {.material = 2});
        builder.add_moving_shape(ball(), {.material = 2}, arm(0), arm(1));
        builder.add_moving_shape(card(), {.material = 2}, arm(0), arm(1));
        builder.end_object();
        builder.add_instance("arm", use(0, 0));
        builder.add_instance("arm", use(1, 0), use(1, 1));
        builder.finish();
        return b;
    }
    static SceneBuilder still(double t) {
        SceneBuilder b = lamp_and_floor();
        CallMessages messages("scene of a test");
        montelux::SceneBuilder builder(b.scene, messages);
        for (int i = 0; i < uses; ++i) {
            const std::string name = std::to_string(i);
            builder.begin_object(name);
            builder.add_shape(card(), {.material = 2});
            builder.end_object();
            builder.add_instance(name, use(i, t));
            builder.begin_object("arm" + name);
            builder.add_shape(ball(), {.material = 2});
            builder.add_shape(card(), {.material = 2});
            builder.end_object();
            builder.add_instance("arm" + name, use(i, t) * arm(t));
        }
        builder.finish();
        return b;
    }
};

TEST(MotionBlur, OfShapesInObjectsIsTheMeanOfPicturesThatStandStill) {
    SceneBuilder b = TurningArms::moving();
    EXPECT_EQ(b.scene.instances.size(), 4u);
    b.description.sampler.spp = 2048;
    expect_mean_of_frames(b.description, [](float t) {
        SceneDescription d = TurningArms::still(double(t)).description;
        d.sampler.spp = 64;
        return d;
    });
}

// In an object that is used once, where it is.
TEST(MotionBlur, OfAShapeInAnObjectIsThatOfTheShapeInTheWorld) {
    const auto film = [](bool in_object) {
        SceneBuilder b = TurningArms::lamp_and_floor();
        CallMessages messages("scene of a test");
        montelux::SceneBuilder builder(b.scene, messages);
        const Transform up = Transform::translate({0, 0, 1});
        if (in_object) builder.begin_object("o");
        builder.add_moving_shape(TurningArms::card(), {.material = 2}, up * TurningArms::arm(0),
                                 up * TurningArms::arm(1));
        builder.end_object();
        if (in_object) builder.add_instance("o", Transform());
        builder.finish();
        return render(b.description);
    };
    const Film a = film(false), b = film(true);
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        EXPECT_TRUE(same_pixel(a.pixels()[i], b.pixels()[i])) << i;
}

// As passing_square, of a square that grows by `growth` to either side instead.
SceneBuilder growing_square(float growth) {
    SceneBuilder b = passing_square(0);
    b.scene.motions.clear();
    b.scene.instances.clear();
    b.scene.objects.clear();
    b.scene.world_shapes = {0};
    TriangleMesh& mesh = b.scene.meshes[0];
    mesh.end_positions = mesh.positions;
    for (Point3f& p : mesh.end_positions) p.x *= 1 + growth;
    return b;
}

// The share of the exposure during which |x| > 1 + growth * t.
double not_grown_to(double x, double growth, double from, double to) {
    return std::clamp(((std::abs(x) - 1) / growth - from) / (to - from), 0.0, 1.0);
}

TEST(MotionBlur, AGrowingSquareBlursToARamp) {
    constexpr double growth = 2;
    expect_blur(growing_square(growth), {{0.0f, 1.0f}, {0.25f, 0.5f}, {2.0f, 3.0f}},
                [](double x, double open, double close) {
                    return open > 1 ? double(std::abs(x) > 1 + growth) : not_grown_to(x, growth, open, close);
                });
}

// A lamp over a floor, and between them a mesh whose corners and normals change; `t`: as it is at that time.
SceneBuilder flapping_sheet(std::optional<float> t = {}) {
    SceneBuilder b = TurningArms::lamp_and_floor();
    TriangleMesh mesh = square(Transform::translate({0, 0, 1.2}));
    mesh.normals.assign(4, {0, 0, 1});
    mesh.end_positions = {{-0.4f, -1.2f, 1}, {1.6f, -0.6f, 2}, {0.7f, 1, 0.6f}, {-1.2f, 0.4f, 1.7f}};
    mesh.end_normals = {{-0.3f, 0, 0.9f}, {0.4f, 0.1f, 1}, {0, 0.5f, 0.8f}, {0, 0, 1}};
    if (t) {
        for (Index v = 0; v < 4; ++v) {
            mesh.positions[v] = mesh.position(v, *t);
            mesh.normals[v] = mesh.normal(v, *t);
        }
        mesh.end_positions.clear();
        mesh.end_normals.clear();
    }
    b.add_mesh(std::move(mesh), 2);
    return b;
}

TEST(MotionBlur, OfADeformingMeshIsTheMeanOfPicturesThatStandStill) {
    SceneBuilder b = flapping_sheet();
    b.description.sampler.spp = 2048;
    expect_mean_of_frames(b.description, [](float t) {
        SceneDescription d = flapping_sheet(t).description;
        d.sampler.spp = 64;
        return d;
    });
}

// Diffuse surfaces are shaded in lanes, replays are not.
void expect_replays(SceneBuilder b) {
    b.description.sampler.spp = 8;
    const Renderer renderer(b.description);
    Film film(b.description.film);
    renderer.render(film);
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) {
            Pixel pixel;
            for (std::uint32_t i = 0; i < 8; ++i) {
                const SampleRecord r = renderer.replay(x, y, i);
                EXPECT_GE(r.time, 0);
                EXPECT_LE(r.time, 1);
                pixel.add_sample(r.contribution);
                pixel.end_replicate();
            }
            EXPECT_TRUE(same_pixel(pixel, film.pixel(x, y))) << x << "," << y;
        }
}

TEST(MotionBlur, ReplaysHaveTheSameBits) {
    expect_replays(tumbling_box());
    expect_replays(TurningArms::moving());
    expect_replays(flapping_sheet());
    SceneBuilder soft = flapping_sheet();
    soft.description.integrator.shading_terminator = ShadingTerminator::soft;
    expect_replays(soft);
}

// Without motion the samples do not spend a number on time.
TEST(MotionBlur, ScenesThatStandStillKeepTheirSamples) {
    SceneBuilder still = tumbling_box();
    still.scene.motions.clear();
    still.scene.instances[0].motion = no_index;
    SceneBuilder shutter(still);
    shutter.scene.camera.shutter_open = 0.25f;
    const Film a = render(still.description), b = render(shutter.description);
    for (std::size_t i = 0; i < a.pixels().size(); ++i) EXPECT_TRUE(same_pixel(a.pixels()[i], b.pixels()[i]));
}

} // namespace
} // namespace montelux::testing
