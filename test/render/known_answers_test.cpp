// Pictures whose radiance is known from algebra. Each comparison is at 5 standard errors (a false alarm
// in 1.7 million) plus rounding.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

#include "montelux/image/image.h"

namespace montelux::testing {
namespace {

constexpr Strategy strategies[] = {Strategy::uniform, Strategy::bsdf, Strategy::light, Strategy::mis};
void expect_picture(const SceneDescription& d, double truth, const std::string& what,
                    double tolerance = 2e-4) {
    PictureMean m = picture_mean(render(d));
    EXPECT_NEAR(m.mean, truth, 5 * m.standard_error + tolerance * truth) << what;
}

// Inside a closed surface of albedo rho that emits E, radiance is E (1 + rho + rho^2 + ...).
SceneBuilder furnace(float rho) {
    SceneBuilder b;
    Sphere sphere;
    b.add_quadric(sphere, b.add(DiffuseMaterial{gray(rho)}), 1, true);
    b.look({0.2, 0.1, -0.3}, {1, 0, 0}, 60);
    b.description.integrator.max_depth = 200;
    return b;
}

TEST(KnownAnswers, FurnaceWithEveryStrategyAndHeuristic) {
    SceneBuilder b = furnace(0.5f);
    for (Strategy s : strategies)
        for (Heuristic h : {Heuristic::balance, Heuristic::power}) {
            b.description.integrator.strategy = s;
            b.description.integrator.heuristic = h;
            expect_picture(b.description, 2, "strategy " + std::to_string(int(s)));
        }
}

TEST(KnownAnswers, FurnaceWithEverySampler) {
    SceneBuilder b = furnace(0.8f);
    for (SamplerKind k : samplers) {
        b.description.sampler.kind = k;
        expect_picture(b.description, 5, "sampler " + std::to_string(int(k)));
    }
}

TEST(KnownAnswers, DepthCutsTheSeries) {
    SceneBuilder b = furnace(0.5f);
    for (int depth : {0, 1, 2, 3}) {
        b.description.integrator.max_depth = depth;
        expect_picture(b.description, 2 - std::pow(0.5, depth), "depth " + std::to_string(depth));
    }
}

// What neither absorbs nor emits cannot be seen against uniform light.
TEST(KnownAnswers, WhiteFurnaceOfEachLosslessMaterial) {
    RoughnessParameter smooth{FloatParameter{0}, FloatParameter{0}, false};
    CoatingParameters clear{
        .roughness = smooth, .eta = 1.5f, .thickness = {0}, .albedo = gray(0), .g = {0}, .max_depth = 400};
    ConductorMaterial mirror{.metal = {.reflectance = gray(1), .from_reflectance = true},
                             .roughness = smooth};
    const std::pair<const char*, Material> cases[] = {
        {"diffuse", DiffuseMaterial{gray(1)}},
        {"leaf", DiffuseTransmissionMaterial{gray(0.7f), gray(0.3f)}},
        {"mirror", mirror},
        {"glass", DielectricMaterial{1.5f, smooth}},
        {"thin glass", ThinDielectricMaterial{1.5f}},
        {"coated diffuse", CoatedDiffuseMaterial{gray(1), clear}},
        {"coated conductor", CoatedConductorMaterial{mirror.metal, smooth, clear}},
    };
    for (const auto& [name, material] : cases)
        for (bool from_map : {false, true}) {
            SceneBuilder b;
            b.add_quadric(Sphere{}, b.add(material));
            if (from_map) {
                Image map(8, 8, {"R", "G", "B"});
                std::fill(map.f32().begin(), map.f32().end(), 1.0f);
                b.scene.environments.push_back(map);
                b.scene.lights.push_back(
                    ImageInfiniteLight{.environment = 0, .scale = white_scale(), .world_from_light = {}});
            } else {
                b.add_uniform_light(1);
            }
            b.look({0, -4, 1}, {0, 0, 0}, 40);
            b.description.integrator.max_depth = 400;
            // Mirrors of reflectance 0.9999 are the nearest that an index of refraction gives.
            expect_picture(b.description, 1, name, 1.5e-3);
        }
}

// Microfacets lose what bounces more than once between them, and nothing may be gained.
TEST(KnownAnswers, WhiteFurnaceOfRoughMaterials) {
    for (float alpha : {0.05f, 0.3f}) {
        RoughnessParameter rough{FloatParameter{alpha}, FloatParameter{alpha}, false};
        const Material cases[] = {
            ConductorMaterial{.metal = {.reflectance = gray(1), .from_reflectance = true},
                              .roughness = rough},
            DielectricMaterial{1.5f, rough}};
        for (const Material& material : cases) {
            SceneBuilder b;
            b.add_quadric(Sphere{}, b.add(material));
            b.add_uniform_light(1);
            b.look({0, -4, 1}, {0, 0, 0}, 40);
            b.description.integrator.max_depth = 100;
            PictureMean m = picture_mean(render(b.description));
            EXPECT_LT(m.mean, 1 + 5 * m.standard_error);
            EXPECT_GT(m.mean, 0.85);
        }
    }
}

// A small patch of a diffuse floor, seen from above.
SceneBuilder floor_scene(float rho) {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({100, 100, 1})), b.add(DiffuseMaterial{gray(rho)}));
    b.look({0, -0.01, 5}, {0, 0, 0}, 0.05f);
    b.description.integrator.max_depth = 1;
    return b;
}

TEST(KnownAnswers, PointSpotAndDistantLights) {
    const double rho = 0.6;
    SceneBuilder point = floor_scene(0.6f);
    point.scene.lights.push_back(PointLight{white_light(point.scene), 3 * white_scale(), {3, 0, 4}});
    double expected = rho / pi * 3 * 0.8 / 25;
    for (Strategy s : strategies) {
        point.description.integrator.strategy = s;
        expect_picture(point.description, expected, "point");
    }
    SceneBuilder spot = floor_scene(0.6f);
    spot.scene.lights.push_back(SpotLight{
        white_light(spot.scene), 3 * white_scale(), {3, 0, 4}, normalize(Vec3f{-3, 0, -4}), 0.99f, 0.9f});
    expect_picture(spot.description, expected, "spot");
    std::get<SpotLight>(spot.scene.lights[0]).axis = {0, 0, -1};
    expect_picture(spot.description, 0, "outside the cone");
    SceneBuilder distant = floor_scene(0.6f);
    distant.scene.lights.push_back(
        DistantLight{white_light(distant.scene), 2 * white_scale(), normalize(Vec3f{1, 0, 1})});
    expect_picture(distant.description, rho / pi * 2 * std::sqrt(0.5), "distant");
}

TEST(KnownAnswers, AreaLightsByFormFactor) {
    const double rho = 0.6;
    for (Strategy s : {Strategy::uniform, Strategy::bsdf, Strategy::light, Strategy::mis}) {
        // A disc of radius r at height h over the point: form factor r^2 / (r^2 + h^2).
        SceneBuilder disc = floor_scene(0.6f);
        Index black = disc.add(DiffuseMaterial{gray(0)});
        disc.add_quadric(Disk{.radius = 2, .world_from_object = Transform::translate({0, 0, 10})}, black, 4,
                         true);
        disc.description.integrator.strategy = s;
        disc.description.sampler.spp = 1024;
        disc.look({0, -0.5, 5}, {0, 0, 0}, 0.05f);
        expect_picture(disc.description, rho * 4 * 4.0 / 104, "disc");
        // A sphere of radius r at distance d straight above: r^2 / d^2.
        SceneBuilder sphere = floor_scene(0.6f);
        black = sphere.add(DiffuseMaterial{gray(0)});
        sphere.add_quadric(Sphere{.world_from_object = Transform::translate({0, 0, 10})}, black, 4);
        sphere.description.integrator.strategy = s;
        sphere.description.sampler.spp = 1024;
        sphere.look({0, -0.5, 5}, {0, 0, 0}, 0.05f);
        expect_picture(sphere.description, rho * 4 / 100, "sphere");
        // A square of half side a over the centre at height h: four corners of a/h in closed form.
        SceneBuilder rectangle = floor_scene(0.6f);
        black = rectangle.add(DiffuseMaterial{gray(0)});
        rectangle.add_mesh(square(Transform::translate({0, 0, 8}) * Transform::rotate(180, {1, 0, 0}) *
                                  Transform::scale({3, 3, 1})),
                           black, 4);
        rectangle.description.integrator.strategy = s;
        rectangle.description.sampler.spp = 1024;
        rectangle.look({0, -0.5, 5}, {0, 0, 0}, 0.05f);
        double x = 3.0 / 8, q = x / std::sqrt(1 + x * x);
        double corner = 2 * q * std::atan(q) / (2 * pi);
        expect_picture(rectangle.description, rho * 4 * 4 * corner, "square");
    }
}

// An ellipsoid whose axes are scaled differently is sampled by area with a varying density.
TEST(KnownAnswers, StrategiesAgreeOnScaledAndPartialLights) {
    for (int which : {0, 1}) {
        std::vector<PictureMean> means;
        for (Strategy s : {Strategy::bsdf, Strategy::light, Strategy::mis}) {
            SceneBuilder b = floor_scene(0.6f);
            Index black = b.add(DiffuseMaterial{gray(0)});
            Transform place = Transform::translate({1, 0, 4});
            Quadric q =
                which == 0
                    ? Quadric(Sphere{.world_from_object = place * Transform::scale({2, 1, 0.5})})
                    : Quadric(Sphere{
                          .radius = 2, .z_min = -2, .z_max = 0.5f, .phi_max = 4, .world_from_object = place});
            b.add_quadric(q, black, 4);
            b.look({0, -0.5, 1}, {0, 0, 0}, 0.05f);
            b.description.integrator.strategy = s;
            b.description.sampler.spp = 2048;
            means.push_back(picture_mean(render(b.description)));
        }
        for (const PictureMean& m : means)
            EXPECT_NEAR(m.mean, means[0].mean, 5 * std::hypot(m.standard_error, means[0].standard_error))
                << which;
    }
}

// A map with one bright texel among dark ones: density and value must agree texel by texel, for each strategy
// and each way to sample the map, with and without what MIS lets it leave out.
TEST(KnownAnswers, EnvironmentMapStrategiesAgree) {
    struct Case {
        Strategy strategy;
        EnvironmentSampling sampling;
        bool compensation;
    };
    std::vector<Case> cases{{Strategy::bsdf, EnvironmentSampling::tabulated, true}};
    for (EnvironmentSampling sampling :
         {EnvironmentSampling::tabulated, EnvironmentSampling::median_cut, EnvironmentSampling::structured}) {
        cases.push_back({Strategy::light, sampling, true}); // where compensation must not be
        cases.push_back({Strategy::mis, sampling, true});
        cases.push_back({Strategy::mis, sampling, false});
    }
    struct Map {
        EnvironmentLayout layout;
        EnvironmentLookup lookup;
    };
    for (const Map& m : {Map{EnvironmentLayout::equal_area, EnvironmentLookup::nearest},
                         Map{EnvironmentLayout::equirectangular, EnvironmentLookup::nearest},
                         Map{EnvironmentLayout::equal_area, EnvironmentLookup::bilinear}}) {
        std::vector<PictureMean> means;
        for (const Case& c : cases) {
            SceneBuilder b = floor_scene(0.6f);
            Image map(8, 8, {"R", "G", "B"});
            for (int i = 0; i < 64; ++i)
                for (int k = 0; k < 3; ++k)
                    map.set(i % 8, i / 8, k,
                            0.1f + static_cast<float>((i * 7) % 11) + (i == 35 ? 40.0f : 0.0f));
            b.scene.environments.push_back(map);
            b.scene.lights.push_back(
                ImageInfiniteLight{.environment = 0,
                                   .layout = m.layout,
                                   .scale = white_scale(),
                                   .world_from_light = Transform::rotate(30, {1, 2, 3})});
            b.description.integrator.strategy = c.strategy;
            b.description.integrator.environment_sampling = c.sampling;
            b.description.integrator.environment_compensation = c.compensation;
            b.description.integrator.environment_lookup = m.lookup;
            b.description.sampler.spp = 512;
            means.push_back(picture_mean(render(b.description)));
        }
        for (std::size_t i = 0; i < means.size(); ++i)
            EXPECT_NEAR(means[i].mean, means[0].mean,
                        5 * std::hypot(means[i].standard_error, means[0].standard_error))
                << i;
    }
}

} // namespace
} // namespace montelux::testing
