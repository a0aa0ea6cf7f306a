// Pictures of bidirectional path tracing and of light tracing against those of path tracing.
#include "test/render/agreement.h"
#include "test/render/mixed_scene.h"
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace montelux::testing {
namespace {

std::vector<AgreementCase> lights_of_all_kinds() {
    std::vector<AgreementCase> cases;
    const auto add = [&](const char* name, const auto& light) {
        SceneBuilder b = lit_corner();
        light(b, white_light(b.scene));
        cases.push_back({name, b});
        cases.push_back({std::string(name) + " by light", b, by_light});
    };
    add("point", [](SceneBuilder& b, SceneSpectrum s) {
        b.scene.lights.push_back(PointLight{s, 4 * white_scale(), {0.4f, -0.5f, 1.5f}});
    });
    add("spot", [](SceneBuilder& b, SceneSpectrum s) {
        SpotLight spot;
        spot.spectrum = s;
        spot.scale = 9 * white_scale();
        spot.position = {0.5f, -1, 2};
        spot.axis = normalize(Vec3f(-0.5f, 1.2f, -1.8f));
        spot.cos_falloff_start = 0.8f;
        spot.cos_total_width = 0.6f;
        b.scene.lights.push_back(spot);
    });
    add("distant", [](SceneBuilder& b, SceneSpectrum s) {
        b.scene.lights.push_back(DistantLight{s, 2 * white_scale(), normalize(Vec3f(0.3f, -1, 1))});
    });
    add("sky", [](SceneBuilder& b, SceneSpectrum) { b.add_uniform_light(0.7f); });
    add("lamp", [](SceneBuilder& b, SceneSpectrum) { add_box_lamp(b); });
    add("sphere", [](SceneBuilder& b, SceneSpectrum) {
        const Transform above = Transform::translate({0.2, -0.3, 2.6});
        b.add_quadric(Sphere{.radius = 0.3f, .z_min = -0.3f, .z_max = 0.3f, .world_from_object = above},
                      b.add(DiffuseMaterial{gray(0)}), 9);
    });
    add("map", [](SceneBuilder& b, SceneSpectrum) {
        Image map(8, 8, {"R", "G", "B"});
        for (int i = 0; i < 64; ++i)
            for (int c = 0; c < 3; ++c) map.set(i % 8, i / 8, c, i == 20 ? 6.0f : 0.3f);
        b.scene.environments.push_back(map);
        b.scene.lights.push_back(
            ImageInfiniteLight{.environment = 0, .scale = white_scale(), .world_from_light = {}});
    });
    return cases;
}

std::vector<AgreementCase> rooms() {
    std::vector<AgreementCase> cases;
    SceneBuilder b = mixed_scene(1, 8, 8);
    for (const int depth : {1, 2, 3, 4, 5, 6}) {
        b.description.integrator.max_depth = depth;
        cases.push_back({"depth " + std::to_string(depth), b});
    }
    b.description.integrator.heuristic = Heuristic::balance;
    cases.push_back({"balance", b});
    return cases;
}

// Vertex normals, coats, textures, motion; lenses, orthographic cameras, filters wider than a pixel, and crops.
std::vector<AgreementCase> surfaces_and_cameras() {
    std::vector<AgreementCase> cases;
    const auto add = [&](const char* name, const SceneBuilder& b) {
        cases.push_back({.name = name, .scene = b, .samples = 24});
        cases.push_back({std::string(name) + " by light", b, by_light, 24});
    };
    SceneBuilder plain = lit_corner();
    add_box_lamp(plain);

    SceneBuilder normals = plain;
    TriangleMesh bent = square(Transform::translate({-0.2, -0.2, 0.3}) * Transform::rotate(25, {0, 1, 0}) *
                               Transform::scale({0.6, 0.6, 1}));
    for (const Vec3f n :
         {Vec3f{-0.6f, -0.2f, 1}, Vec3f{0.8f, 0, 1}, Vec3f{0.6f, 0.6f, 1}, Vec3f{-0.3f, 0.7f, 1}})
        bent.normals.push_back(normalize(n));
    normals.add_mesh(bent, normals.add(DiffuseMaterial{gray(0.8f)}));
    add("shading normals", normals);

    SceneBuilder coated = lit_corner(CoatedDiffuseMaterial{
        gray(0.6f),
        CoatingParameters{.roughness = alpha_of(0.4f), .eta = 1.5f, .albedo = gray(0), .g = {0}}});
    add_box_lamp(coated);
    add("coat", coated);

    SceneBuilder lens = plain;
    lens.description.film.crop = {1, 2, 8, 7};
    lens.description.film.filter = GaussianFilter{};
    lens.scene.camera.model = PerspectiveCamera{.fov = 40, .lens_radius = 0.3f, .focal_distance = 3};
    add("lens", lens);

    SceneBuilder parallel = plain;
    parallel.description.film.filter = MitchellFilter{};
    parallel.scene.camera.model = OrthographicCamera{.screen_window = ScreenWindow{-1.2f, 1.2f, -1, 1.4f}};
    add("orthographic", parallel);

    SceneBuilder moving = plain;
    moving.scene.camera.motion =
        Motion(moving.scene.camera.world_from_camera,
               Transform::translate({0.3, 0, 0.1}) * moving.scene.camera.world_from_camera);
    add("moving camera", moving);
    return cases;
}

// Refraction, smooth and rough, with dispersion: importance is not scaled as radiance is.
std::vector<AgreementCase> glass() {
    const Spectrum flint(PiecewiseLinear::from_pairs(std::array{360.0f, 1.8f, 830.0f, 1.5f}));
    std::vector<AgreementCase> cases;
    for (const float alpha : {0.0f, 0.3f, 0.6f}) {
        SceneBuilder b = lit_corner();
        add_box_lamp(b, 1);
        const Transform t = Transform::translate({0, -0.2, 0.6}) * Transform::scale({0.5, 0.5, 0.5});
        b.add_quadric(Sphere{.world_from_object = t},
                      b.add(DielectricMaterial{add_spectrum(b.scene, flint), alpha_of(alpha)}));
        cases.push_back({"glass of alpha " + std::to_string(alpha), b});
        if (alpha > 0.5f) cases.push_back({"rough glass by light", b, by_light});
    }
    return cases;
}

TEST(BidirectionalPictures, LightsOfAllKinds) { expect_agreement_of(lights_of_all_kinds()); }
TEST(BidirectionalPictures, EachDepthOfARoom) { expect_agreement_of(rooms()); }
TEST(BidirectionalPictures, SurfacesAndCameras) { expect_agreement_of(surfaces_and_cameras()); }
TEST(BidirectionalPictures, GlassWithDispersion) { expect_agreement_of(glass()); }

// The same with so many samples that a bias of 1 % would show.
TEST(BidirectionalPicturesSlowTest, NoBiasOfOnePerCent) {
    // Caustics of glass are noisier, and take more samples for the same precision.
    const std::pair<std::vector<AgreementCase>, std::uint32_t> sets[] = {
        {lights_of_all_kinds(), 40}, {rooms(), 40}, {surfaces_and_cameras(), 40}, {glass(), 80}};
    for (const auto& [cases, more] : sets)
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Agreement r = agreement_in(cases[i], i, 48 * more);
            EXPECT_LT(r.sigmas, 7) << cases[i].name << ": " << 100 * r.bias << " %";
            EXPECT_LT(r.bias, 0.01) << cases[i].name;
            EXPECT_LT(r.error, 0.004) << cases[i].name;
        }
}

} // namespace
} // namespace montelux::testing
