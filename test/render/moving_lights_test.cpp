// Pictures of lights that move: closed forms, agreement of the strategies, and the mean of pictures that stand still.
// Each comparison of means is at 5 standard errors.
#include "test/render/motion_testing.h"
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "montelux/render/sample_record.h"
#include "montelux/scene/light/emissive_shape.h"

namespace montelux::testing {
namespace {

// The radiance of a point of a diffuse floor, albedo 0.6, under lights that move.
SceneBuilder floor_below() {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({100, 100, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    b.add(DiffuseMaterial{gray(0)});
    b.description.integrator.max_depth = 1;
    b.description.sampler.spp = 1024;
    b.look({0, -0.2, 1}, {0, 0, 0}, 0.01f);
    return b;
}

void expect_radiance(const SceneBuilder& b, double truth, const std::string& name) {
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        SceneDescription d = b.description;
        d.sampler.kind = kind;
        const PictureMean m = picture_mean(render(d));
        EXPECT_NEAR(m.mean, truth, 5 * m.standard_error + 1e-5 * truth) << name;
        EXPECT_LT(m.standard_error, 0.02 * truth) << name;
    }
}

// Of h / (h^2 + x^2)^(3/2) over x in [a, b].
double falloff(double a, double b, double h) {
    const auto integral = [&](double x) { return x / (h * std::sqrt(h * h + x * x)); };
    return integral(b) - integral(a);
}

// A lamp at height h that moves from x = a to b.
TEST(MovingLights, PointOverAFloor) {
    const double a = -1, b = 5, h = 1.5;
    SceneBuilder scene = floor_below();
    CallMessages messages("a test");
    montelux::SceneBuilder(scene.scene, messages)
        .add_moving_light(
            PointLight{white_light(scene.scene), 3 * white_scale(), {static_cast<float>(a), 0, 0}},
            Transform::translate({0, 0, h}), Transform::translate({b - a, 0, h}));
    expect_radiance(scene, 0.6 / pi * 3 * falloff(a, b, h) / (b - a), "from -1 to 5");
    // The first half of the way.
    scene.scene.camera.shutter_close = 0.5f;
    expect_radiance(scene, 0.6 / pi * 3 * falloff(a, 2, h) / 3, "from -1 to 2");
}

Emission emission_of(Scene& scene, float radiance) {
    return {.spectrum = white_light(scene), .scale = radiance * white_scale()};
}

// The irradiance of a sphere above the horizon is that of a point: pi L r^2 h / d^3, however large it is.
TEST(MovingLights, SphereThatGrowsOverAFloor) {
    const double a = -1, b = 5, h = 1.5, r0 = 0.1, r1 = 1.4;
    double mean = 0; // over the time
    constexpr int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double t = (i + 0.5) / n, x = a + (b - a) * t, r = r0 + (r1 - r0) * t;
        mean += pi * 4 * r * r * h / std::pow(h * h + x * x, 1.5) / n;
    }
    for (const Strategy s : {Strategy::bsdf, Strategy::light, Strategy::mis}) {
        SceneBuilder scene = floor_below();
        scene.description.integrator.strategy = s;
        scene.description.sampler.spp = s == Strategy::mis ? 4096 : 16384;
        CallMessages messages("a test");
        montelux::SceneBuilder builder(scene.scene, messages);
        const Emission emission = emission_of(scene.scene, 4);
        builder.add_moving_shape(Sphere{.world_from_object = {}},
                                 {.material = 1, .alpha = {1}, .emission = &emission},
                                 Transform::translate({a, 0, h}) * Transform::scale({r0, r0, r0}),
                                 Transform::translate({b, 0, h}) * Transform::scale({r1, r1, r1}));
        builder.finish();
        expect_radiance(scene, 0.6 / pi * mean, "strategy " + std::to_string(static_cast<int>(s)));
    }
}

// Emitters of all shapes that move above a floor beside a still one; with a time, they stand where they are then.
class Swarm {
  public:
    explicit Swarm(std::optional<float> time = {}) : time_(time), scene_(floor()) {
        CallMessages messages("a test");
        montelux::SceneBuilder builder(scene_.scene, messages);
        builder_ = &builder;
        const Transform down = Transform::rotate(180, {1, 0, 0});
        const auto at = [](double x, double y, double z) { return Transform::translate({x, y, z}); };
        const Quadric disk = Disk{.radius = 0.5f, .world_from_object = {}};
        const Quadric ball = Sphere{.radius = 0.5f, .z_min = -0.5f, .z_max = 0.5f, .world_from_object = {}};
        add(square(Transform::scale({0.4, 0.4, 1})), 3, at(-2, 1, 1) * down,
            at(-1, 1, 1.5) * Transform::rotate(120, {1, 0, 0}));
        // Mirrored: its front is that of the still one.
        add(disk, 4, at(2, 1, 1) * Transform::scale({1, 1, -1}),
            at(1, 0, 2) * Transform::rotate(50, {0, 1, 0}) * Transform::scale({1, 2, -1}));
        add(ball, 5, at(0, -1, 0.3) * Transform::scale({0.05, 0.05, 0.05}), at(1, -1, 2)); // grows by 20
        add(ball, 2, at(-1, -1, 1), at(-2, -2, 1) * Transform::scale({1, 0.4, 2}));
        add(waving(), 3, {}, {});
        const Emission emission = emission_of(scene_.scene, 6);
        builder.add_shape(square(at(0, 0, 4) * down * Transform::scale({0.3, 0.3, 1})),
                          {.material = 1, .alpha = {1}, .emission = &emission});
        add_light(PointLight{white_light(scene_.scene), white_scale(), {1, 0, 0}}, at(0, 2, 1),
                  at(-1, 2, 1) * Transform::rotate(90, {0, 0, 1}));
        add_light(SpotLight{white_light(scene_.scene), 4 * white_scale(), {}, {0, 0, -1}, 0.95f, 0.85f},
                  at(1, 1, 3) * Transform::rotate(30, {1, 0, 0}),
                  at(1, 1, 3) * Transform::rotate(-30, {1, 0, 0}));
        builder.finish();
        scene_.description.integrator.max_depth = 3;
        scene_.description.integrator.light_sampling = LightSampling::tree;
    }
    SceneDescription& description() { return scene_.description; }

  private:
    static SceneBuilder floor() {
        SceneBuilder b;
        b.description.film.width = b.description.film.height = 12;
        b.description.film.crop = {0, 0, 12, 12};
        b.add_mesh(square(Transform::scale({5, 5, 1})), b.add(DiffuseMaterial{gray(0.7f)}));
        b.add(DiffuseMaterial{gray(0.3f)});
        b.look({0, -8, 5}, {0, 0, 0.7}, 45);
        return b;
    }
    static TriangleMesh waving() {
        TriangleMesh m = square(Transform::translate({0, 1, 2}) * Transform::rotate(180, {1, 0, 0}) *
                                Transform::scale({0.5, 0.5, 1}));
        m.end_positions = m.positions;
        for (Point3f& p : m.end_positions) p = {2 * p.x, p.y - 0.5f, p.z + p.x};
        return m;
    }
    void add(Geometry geometry, float radiance, const Transform& start, const Transform& end) {
        const Emission emission = emission_of(scene_.scene, radiance);
        ShapeSettings settings{.material = 1, .alpha = {1}, .emission = &emission};
        const bool quadric = std::holds_alternative<Quadric>(geometry);
        settings.flip_normal = quadric && start.swaps_handedness(); // as in pbrt's files
        if (!time_) {
            if (start == end)
                builder_->add_shape(std::move(geometry), settings);
            else
                builder_->add_moving_shape(std::move(geometry), settings, start, end);
            return;
        }
        const Transform t = start == end ? start : Motion(start, end).at(*time_);
        if (quadric) {
            geometry = placed(std::get<Quadric>(geometry), t);
        } else {
            auto& mesh = std::get<TriangleMesh>(geometry);
            for (Index v = 0; v < mesh.positions.size(); ++v) mesh.positions[v] = mesh.position(v, *time_);
            mesh.end_positions.clear();
            transform_mesh(mesh, t);
            settings.flip_normal = t.swaps_handedness();
        }
        builder_->add_shape(std::move(geometry), settings);
    }
    template <typename L>
    void add_light(const L& light, const Transform& start, const Transform& end) {
        if (time_)
            builder_->add_light(light.moved(Motion(start, end).at(*time_)));
        else
            builder_->add_moving_light(light, start, end);
    }

    std::optional<float> time_;
    SceneBuilder scene_;
    montelux::SceneBuilder* builder_ = nullptr;
};

TEST(MovingLights, AreTheMeanOfPicturesThatStandStill) {
    Swarm moving;
    moving.description().sampler.spp = 2048;
    expect_mean_of_frames(moving.description(), [](float t) {
        Swarm still(t);
        still.description().sampler.spp = 64;
        return still.description();
    });
}

TEST(MovingLights, StrategiesAndChoicesAgree) {
    struct Way {
        Strategy strategy;
        LightSampling choice;
        int spp;
    };
    std::vector<PictureMean> means;
    for (const Way& way :
         {Way{Strategy::mis, LightSampling::tree, 1024}, Way{Strategy::mis, LightSampling::power, 1024},
          Way{Strategy::mis, LightSampling::uniform, 1024}, Way{Strategy::light, LightSampling::tree, 2048},
          Way{Strategy::light, LightSampling::power, 2048}, Way{Strategy::bsdf, LightSampling::tree, 8192},
          Way{Strategy::mis, LightSampling::tree, 1024}}) {
        Swarm swarm;
        swarm.description().integrator.strategy = way.strategy;
        swarm.description().integrator.light_sampling = way.choice;
        swarm.description().sampler.spp = way.spp;
        swarm.description().sampler.seed = means.size();
        means.push_back(picture_mean(render(swarm.description())));
        EXPECT_NEAR(means.back().mean, means[0].mean,
                    5 * std::hypot(means.back().standard_error, means[0].standard_error))
            << means.size();
        EXPECT_LT(means.back().standard_error, 0.01 * means[0].mean) << means.size();
    }
}

TEST(MovingLights, ReplaysHaveTheSameBits) {
    Swarm swarm;
    swarm.description().sampler.spp = 8;
    const Renderer renderer(swarm.description());
    Film film(swarm.description().film);
    renderer.render(film);
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) {
            Pixel pixel;
            for (std::uint32_t i = 0; i < 8; ++i) {
                pixel.add_sample(renderer.replay(x, y, i).contribution);
                pixel.end_replicate();
            }
            EXPECT_TRUE(same_pixel(pixel, film.pixel(x, y))) << x << "," << y;
        }
}

// Fog that is lit by a lamp and a disk that move: scattering in media, and distances that are chosen for lights.
SceneDescription fog(std::optional<float> time = {}) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 10;
    b.description.film.crop = {0, 0, 10, 10};
    b.description.integrator.max_depth = 3;
    HomogeneousMedium medium;
    medium.sigma_a = 0.05f;
    medium.sigma_s = 0.2f;
    b.scene.media = {medium};
    b.scene.camera.medium = 0;
    b.add(DiffuseMaterial{gray(0.5f)});
    CallMessages messages("a test");
    montelux::SceneBuilder builder(b.scene, messages);
    ShapeSettings inside{.material = 0, .alpha = {1}, .media = {0, 0}};
    builder.add_shape(square(Transform::translate({0, 0, -1.5}) * Transform::scale({3, 3, 1})), inside);
    const Transform start = Transform::translate({-1.5, 0, 0}),
                    end = Transform::translate({1.5, 0, 0.5}) * Transform::rotate(100, {0, 0, 1});
    const Motion motion(start, end);
    const PointLight lamp{white_light(b.scene), 2 * white_scale(), {0, 0.3f, 0.2f}};
    const Emission emission = emission_of(b.scene, 8);
    inside.emission = &emission;
    const Disk disk{.radius = 0.4f, .world_from_object = Transform::rotate(90, {1, 0, 0})};
    if (time) {
        builder.add_light(lamp.moved(motion.at(*time)));
        Disk there = disk;
        there.world_from_object = motion.at(*time) * disk.world_from_object;
        builder.add_shape(Quadric(there), inside);
    } else {
        builder.add_moving_light(lamp, start, end);
        builder.add_moving_shape(Quadric(disk), inside, start, end);
    }
    builder.finish();
    b.look({0, -6, 1}, {0, 0, 0}, 40);
    b.description.sampler.spp = time ? 64 : 2048;
    return b.description;
}

TEST(MovingLights, InFogAreTheMeanOfPicturesThatStandStill) {
    for (const bool equiangular : {true, false}) {
        SceneDescription moving = fog();
        moving.integrator.equiangular = equiangular;
        expect_mean_of_frames(moving, [](float t) { return fog(t); });
    }
}

} // namespace
} // namespace montelux::testing
