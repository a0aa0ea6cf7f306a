// Bidirectional path tracing and light tracing through media: pictures against those of the volume path tracer, known
// answers, and refusals.
#include "test/render/agreement.h"
#include "test/render/mixed_scene.h"
#include "test/transport/volume_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/light_tracing_support.h"

namespace montelux::testing {
namespace {

// The corner of seed_means.h without light, in a medium that fills all space.
VolumeScene corner_in(const Medium& medium) {
    VolumeScene b;
    b.add_mesh(square(Transform::scale({1.5, 1.5, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    b.add_mesh(square(Transform::translate({0, 1.2, 0.6}) * Transform::rotate(90, {1, 0, 0})),
               b.add(DiffuseMaterial{gray(0.5f)}));
    b.look({0.2, -4, 2.2}, {0, 0, 0.3}, 40);
    b.description.integrator.max_depth = 5;
    if (!std::holds_alternative<HomogeneousMedium>(medium) || std::get<HomogeneousMedium>(medium).scale > 0)
        b.scene.camera.medium = b.add_medium(medium);
    return b;
}
HomogeneousMedium fog(float sigma_a, float sigma_s, float g = 0) {
    HomogeneousMedium m{.sigma_a = sigma_a, .sigma_s = sigma_s};
    m.phase = HenyeyGreenstein{g};
    return m;
}
HomogeneousMedium vacuum() { return HomogeneousMedium{.scale = 0}; }

std::vector<float> lumps(int n) {
    std::vector<float> values;
    for (int i = 0; i < n; ++i)
        values.push_back(i % 3 == 0 ? 0.0f : 0.2f + 0.3f * static_cast<float>(i * 7 % 5));
    return values;
}
// A coloured cloud in the cube [-1, 1]^3 of medium space.
GridMedium cloud(VolumeScene& b) {
    GridMedium m = b.grid_medium(b.add_grid(4, 5, 6, lumps(120)));
    m.sigma_a = b.spectrum(0.3f, 0.05f);
    m.sigma_s = b.spectrum(0.8f, 3);
    m.phase = HenyeyGreenstein{0.3f};
    return m;
}
void add_sphere_lamp(VolumeScene& b, Vec3d at, float radius, float emission) {
    b.add_quadric(Sphere{.radius = radius,
                         .z_min = -radius,
                         .z_max = radius,
                         .world_from_object = Transform::translate(at)},
                  b.add(DiffuseMaterial{gray(0)}), emission);
}
void add_point_lamp(VolumeScene& b) {
    b.scene.lights.push_back(PointLight{white_light(b.scene), 4 * white_scale(), {0.4f, -0.5f, 1.5f}});
}

std::vector<AgreementCase> fogs() {
    std::vector<AgreementCase> cases;
    const auto add = [&](const char* name, const VolumeScene& b) {
        cases.push_back({.name = name, .scene = b, .samples = 24});
        cases.push_back({std::string(name) + " by light", b, by_light, 24});
    };
    VolumeScene point = corner_in(fog(0.02f, 0.15f));
    add_point_lamp(point);
    add("point", point);

    VolumeScene lamp = corner_in(fog(0.05f, 0.2f, 0.6f));
    add_box_lamp(lamp);
    add("lamp", lamp);

    VolumeScene spot = corner_in(vacuum());
    HomogeneousMedium coloured = fog(0, 0, -0.2f);
    coloured.sigma_a = spot.spectrum(0.2f, 0.01f);
    coloured.sigma_s = spot.spectrum(0.05f, 0.5f);
    spot.scene.camera.medium = spot.add_medium(coloured);
    SpotLight light;
    light.spectrum = white_light(spot.scene);
    light.scale = 9 * white_scale();
    light.position = {0.5f, -1, 2};
    light.axis = normalize(Vec3f(-0.5f, 1.2f, -1.8f));
    light.cos_falloff_start = 0.8f;
    light.cos_total_width = 0.6f;
    spot.scene.lights.push_back(light);
    add("coloured fog", spot);
    cases[cases.size() - 2].scene.description.integrator.heuristic = Heuristic::balance;

    // Surfaces that are not closed separate fog and vacuum, as in files that set a medium before the camera.
    VolumeScene one_sided = corner_in(fog(0.02f, 0.15f));
    for (Index shape = 0; shape < one_sided.scene.shapes.size(); ++shape)
        one_sided.bound(shape, no_index, one_sided.scene.camera.medium);
    add_point_lamp(one_sided);
    add("open floor", one_sided);

    // A room whose walls say nothing of media; the camera outside sees it through a pane that holds the fog back.
    VolumeScene room;
    const Index gray_wall = room.add(DiffuseMaterial{gray(0.6f)});
    const auto wall = [&](Vec3d at, const Transform& turn) {
        return room.add_mesh(square(Transform::translate(at) * turn * Transform::scale({2, 2, 2})),
                             gray_wall);
    };
    wall({0, 0, 0}, Transform());
    wall({0, 0, 4}, Transform::rotate(180, {1, 0, 0}));
    wall({0, 2, 2}, Transform::rotate(90, {1, 0, 0}));
    wall({-2, 0, 2}, Transform::rotate(90, {0, 1, 0}));
    wall({2, 0, 2}, Transform::rotate(-90, {0, 1, 0}));
    const Index gas = room.add_medium(fog(0.05f, 0.3f));
    room.bound(room.add_mesh(square(Transform::translate({0, -2, 2}) * Transform::rotate(90, {1, 0, 0}) *
                                    Transform::scale({2, 2, 2})),
                             room.interface()),
               gas, no_index);
    const Index ceiling_lamp =
        room.add_mesh(square(Transform::translate({0.3, 0.2, 3.9}) * Transform::rotate(180, {1, 0, 0}) *
                             Transform::scale({0.5, 0.5, 1})),
                      room.add(DiffuseMaterial{gray(0)}), 10);
    room.bound(ceiling_lamp, no_index, gas);
    room.look({0.2, -7, 2.2}, {0, 0, 1.9}, 30);
    room.description.integrator.max_depth = 5;
    add("room behind a pane", room);

    VolumeScene absorbing = corner_in(fog(0.2f, 0));
    add_box_lamp(absorbing);
    add("no scattering", absorbing);
    return cases;
}

// Media with boundaries of nothing, or without any; lights inside, outside and at infinity.
std::vector<AgreementCase> clouds() {
    std::vector<AgreementCase> cases;
    const auto add = [&](const char* name, const VolumeScene& b, std::uint32_t samples = 24) {
        cases.push_back({.name = name, .scene = b, .samples = samples});
        cases.push_back({std::string(name) + " by light", b, by_light, samples});
    };
    VolumeScene bounded = corner_in(vacuum());
    GridMedium m = cloud(bounded);
    bounded.add_cube(bounded.add_medium(m));
    bounded.add_uniform_light(0.4f);
    bounded.scene.lights.push_back(
        DistantLight{white_light(bounded.scene), white_scale(), normalize(Vec3f(0.3f, -1, 1))});
    add_box_lamp(bounded);
    bounded.look({0.3, -4, 0.6}, {0, 0, 0}, 35);
    add("cloud", bounded);

    VolumeScene open = corner_in(vacuum());
    GridMedium around = cloud(open);
    around.scale = 0.2f;
    around.box.world_from_medium = Transform::translate({0.3, -0.5, 1}) * Transform::scale({6, 5, 6});
    open.scene.camera.medium = open.add_medium(around);
    open.add_uniform_light(0.7f);
    open.look({0.2, -4, 2.2}, {0, 0, 0.3}, 90);
    cases.push_back({.name = "cloud without boundary", .scene = open, .samples = 24});
    // Above the floor alone, whose lower side the medium must not touch.
    VolumeScene sunny = corner_in(vacuum());
    GridMedium above = cloud(sunny);
    above.scale = 0.2f;
    above.box.world_from_medium = Transform::translate({0.3, -0.5, 3.01}) * Transform::scale({6, 5, 3});
    sunny.scene.camera.medium = sunny.add_medium(above);
    sunny.add_uniform_light(0.7f);
    sunny.scene.lights.push_back(
        DistantLight{white_light(sunny.scene), white_scale(), normalize(Vec3f(0.3f, -1, 1))});
    sunny.look({0.2, -4, 2.2}, {0, 0, 0.3}, 60);
    for (Index shape = 0; shape < sunny.scene.shapes.size(); ++shape)
        sunny.bound(shape, no_index, sunny.scene.camera.medium);
    cases.push_back({.name = "open floor under the sun", .scene = sunny, .samples = 24});
    for (Index shape = 0; shape < open.scene.shapes.size(); ++shape)
        open.bound(shape, open.scene.camera.medium, open.scene.camera.medium);
    cases.push_back({.name = "shapes within a cloud", .scene = open, .samples = 24});

    VolumeScene inside = corner_in(vacuum());
    const Index ball = inside.add_medium(fog(0.1f, 1, 0.3f));
    const Transform t = Transform::translate({0, 0, 0.7}) * Transform::scale({0.6, 0.6, 0.6});
    inside.bound(inside.add_quadric(Sphere{.world_from_object = t}, inside.interface()), ball);
    add_sphere_lamp(inside, {0.1, -0.1, 0.8}, 0.25f, 10);
    add("lamp in fog", inside, 48);

    // An interface that shines, on both sides of which there are media.
    VolumeScene screen = corner_in(fog(0.02f, 0.2f));
    const Index thick = screen.add_medium(fog(0.1f, 1));
    screen.bound(screen.add_quadric(Sphere{.world_from_object = t}, screen.interface(), 2), thick,
                 screen.scene.camera.medium);
    add("shining interface", screen);
    return cases;
}

// In glass, smooth and rough, with dispersion; behind panes of nothing; and media that shine.
std::vector<AgreementCase> glass_and_glow() {
    const Spectrum flint(PiecewiseLinear::from_pairs(std::array{360.0f, 1.6f, 830.0f, 1.4f}));
    std::vector<AgreementCase> cases;
    for (const float alpha : {0.0f, 0.4f}) {
        VolumeScene b = corner_in(fog(0.02f, 0.1f));
        add_box_lamp(b, 0.8);
        const Index milk = b.add_medium(fog(0.1f, 3, 0.4f));
        const Transform t = Transform::translate({0, -0.2, 0.6}) * Transform::scale({0.5, 0.5, 0.5});
        b.bound(b.add_quadric(Sphere{.world_from_object = t},
                              b.add(DielectricMaterial{add_spectrum(b.scene, flint), alpha_of(alpha)})),
                milk, b.scene.camera.medium);
        b.description.integrator.max_depth = 6;
        cases.push_back({.name = alpha > 0 ? "rough glass" : "glass", .scene = b, .samples = 24});
        if (alpha > 0) cases.push_back({"rough glass by light", b, by_light, 24});
    }
    VolumeScene panes = corner_in(fog(0.02f, 0.2f));
    add_box_lamp(panes, 1);
    for (const double z : {0.9, 1.2})
        panes.add_mesh(square(Transform::translate({0, 0, z})),
                       panes.add(DielectricMaterial{1.0f, alpha_of(0)}));
    panes.description.integrator.count_passages = false;
    panes.description.integrator.max_depth = 2;
    cases.push_back({.name = "panes", .scene = panes, .samples = 24});

    VolumeScene glow = corner_in(vacuum());
    GridMedium m = cloud(glow);
    m.le = glow.spectrum(0.6f, 0.2f);
    m.box.world_from_medium = Transform::translate({0, 0, 0.8}) * Transform::scale({0.5, 0.5, 0.5});
    HomogeneousMedium dim = fog(0.05f, 0.1f);
    dim.le = 0.1f;
    const Index inner = glow.add_medium(m), outer = glow.add_medium(dim);
    const Transform t = Transform::translate({0, 0, 0.8}) * Transform::scale({0.9, 0.9, 0.9});
    glow.bound(glow.add_quadric(Sphere{.world_from_object = t}, glow.interface()), inner, outer);
    glow.scene.camera.medium = outer;
    add_box_lamp(glow);
    cases.push_back({.name = "glow", .scene = glow, .samples = 24});
    return cases;
}

// Of each set, light tracing alone for the first case only.
void expect_fast_agreement_of(const std::vector<AgreementCase>& cases, double most_error,
                              double most_ratio = 1.1) {
    std::vector<AgreementCase> chosen;
    int by_light_alone = 0;
    for (const AgreementCase& c : cases)
        if (c.method != by_light || by_light_alone++ == 0) chosen.push_back(c);
    expect_agreement_of(chosen, most_error, most_ratio);
}
TEST(BidirectionalMedia, FogsAgree) { expect_fast_agreement_of(fogs(), 0.04); }
TEST(BidirectionalMedia, CloudsAgree) { expect_fast_agreement_of(clouds(), 0.04); }
TEST(BidirectionalMedia, GlassAndGlowAgree) { expect_fast_agreement_of(glass_and_glow(), 0.05, 1.25); }

// The same with so many samples that a bias of 1 % would show.
TEST(BidirectionalMediaSlowTest, NoBiasOfOnePerCent) {
    for (const auto& [cases, more] : {std::pair{fogs(), 40u}, {clouds(), 40u}, {glass_and_glow(), 60u}})
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Agreement r = agreement_in(cases[i], i, 48 * more);
            EXPECT_LT(r.sigmas, 7) << cases[i].name << ": " << 100 * r.bias << " %";
            EXPECT_LT(r.bias, 0.01) << cases[i].name;
            EXPECT_LT(r.error, 0.006) << cases[i].name;
        }
}

// Inside a closed surface of albedo rho that emits E, radiance is E / (1 - rho), whatever scatters there.
TEST(BidirectionalMedia, FurnaceWithScattering) {
    VolumeScene b;
    b.add_quadric(Sphere{}, b.add(DiffuseMaterial{gray(0.5f)}), 1, true);
    HomogeneousMedium m = fog(0, 1, 0.3f);
    m.sigma_s = b.spectrum(0.4f, 2);
    b.scene.camera.medium = b.add_medium(m);
    b.look({0.2, 0.1, -0.3}, {1, 0, 0}, 60);
    b.description.integrator.max_depth = 200;
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
        b.description.integrator.heuristic = heuristic;
        const SeedMeans means = render_of_seeds(b.description, IntegratorKind::bidirectional, 16);
        for (const RunningMoments& channel : means.channel)
            EXPECT_NEAR(channel.mean(), 2, 7 * channel.standard_error() + 1e-3);
    }
}

TEST(BidirectionalMedia, AnyNumberOfThreadsGivesTheSameBits) {
    for (SceneBuilder b : {clouds()[0].scene, glass_and_glow()[0].scene}) {
        b.description.integrator.method = IntegratorKind::bidirectional;
        b.description.sampler.spp = 8;
        std::vector<Film> films;
        for (const int threads : {1, 2, 5})
            with_threads(threads, [&] { films.push_back(render(b.description)); });
        for (std::size_t i = 1; i < films.size(); ++i)
            for (std::size_t p = 0; p < films[0].pixels().size(); ++p)
                ASSERT_TRUE(same_pixel(films[0].pixels()[p], films[i].pixels()[p]));
    }
}

TEST(BidirectionalMedia, RefusesWhatItCannotDo) {
    const auto obstacle = [](const VolumeScene& b, IntegratorKind method) {
        IntegratorSettings settings = b.description.integrator;
        settings.method = method;
        return light_tracing_obstacle(b.scene, settings).value_or("");
    };
    VolumeScene plain = corner_in(fog(0.1f, 1));
    EXPECT_EQ(obstacle(plain, IntegratorKind::bidirectional), "");
    EXPECT_EQ(obstacle(plain, by_light), "");
    plain.description.integrator.count_passages = false;
    EXPECT_EQ(obstacle(plain, by_light), "");

    HomogeneousMedium skin = fog(0.1f, 1);
    skin.is_body = true;
    EXPECT_NE(obstacle(corner_in(skin), IntegratorKind::bidirectional).find("bodies"), std::string::npos);

    HomogeneousMedium flame = fog(0.1f, 1);
    flame.le = 1.0f;
    EXPECT_EQ(obstacle(corner_in(flame), IntegratorKind::bidirectional), "");
    EXPECT_NE(obstacle(corner_in(flame), by_light).find("media emit"), std::string::npos);
    VolumeScene b = corner_in(vacuum());
    GridMedium fire = cloud(b);
    b.add_medium(fire);
    EXPECT_EQ(obstacle(b, by_light), "");
    fire.temperature = fire.density;
    b.add_medium(fire);
    EXPECT_NE(obstacle(b, by_light).find("media emit"), std::string::npos);
}

} // namespace
} // namespace montelux::testing
