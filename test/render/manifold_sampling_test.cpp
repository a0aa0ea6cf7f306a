// Pictures with manifold sampling: closed forms, path tracing, light tracing, and the same bits in any order.
#include "test/render/agreement.h"
#include "test/render/mixed_scene.h"
#include "test/render/render_in_pieces.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include "test/wavy_mesh.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/z_test.h"
#include "montelux/render/render_warnings.h"

namespace montelux::testing {
namespace {

Material perfect_mirror() {
    ConductorMaterial m;
    m.metal.from_reflectance = true;
    m.metal.reflectance = gray(1);
    return m;
}

SceneDescription sampled(const SceneBuilder& b) {
    SceneDescription d = b.description;
    d.integrator.manifold_sampling = true;
    return d;
}

// A mirror that a spot points at past the edge of a black wall, and the image of spot and wall without the mirror: the
// same picture. A second mirror that reflects nothing is chosen half of the time.
TEST(ManifoldSampling, PlaneMirrorsShowTheImageOfALight) {
    SceneBuilder mirrored, image;
    for (SceneBuilder* b : {&mirrored, &image}) {
        b->add_mesh(square(Transform()), b->add(DiffuseMaterial{gray(0.7f)}));
        SpotLight spot;
        spot.spectrum = white_light(b->scene);
        spot.scale = 30 * white_scale();
        spot.position = {b == &mirrored ? -0.5f : 4.5f, 0.2f, 1};
        spot.axis = normalize(Vec3f{b == &mirrored ? 1.0f : -1.0f, 0, -0.2f});
        spot.cos_falloff_start = 0.995f;
        spot.cos_total_width = 0.98f;
        b->scene.lights.push_back(spot);
        b->look({0, -2, 3}, {0, 0, 0}, 25);
        b->description.integrator.max_depth = 2;
    }
    const auto across_x = [](Vec3d at, double size) {
        return square(Transform::translate(at) * Transform::rotate(90, {0, 1, 0}) *
                      Transform::scale({size, size, 1}));
    };
    for (const double x : {2.0, -20.0})
        mirrored.add_mesh(across_x({x, 0, 0}, 9), mirrored.add(perfect_mirror()));
    mirrored.add_mesh(across_x({1.2, 1.2, 1.65}, 1), mirrored.add(DiffuseMaterial{gray(0)}));
    for (const double x : {1.2, 2.8})
        image.add_mesh(across_x({x, 1.2, 1.65}, 1), image.add(DiffuseMaterial{gray(0)}));
    const Agreement r = agreement_of(render_of_seeds(image.description, IntegratorKind::path, 64),
                                     render_of_seeds(sampled(mirrored), IntegratorKind::path, 64));
    EXPECT_LT(r.sigmas, 7) << 100 * r.bias << " %";
    EXPECT_LT(r.error, 0.01);
}

// A light straight above water, seen from the floor: it seems as far as the height and the depth over the index, and
// loses what the surface reflects.
TEST(ManifoldSampling, WaterLiftsTheFloor) {
    constexpr double height = 1.5, depth = 1, eta = 1.33, albedo = 0.8, intensity = 3;
    for (const bool smooth : {false, true}) {
        SceneBuilder b;
        b.add_mesh(square(Transform()), b.add(DiffuseMaterial{gray(albedo)}));
        TriangleMesh water = square(Transform::translate({0, 0, depth}) * Transform::scale({4, 4, 1}));
        if (smooth) water.normals.assign(4, {0, 0, 1});
        b.add_mesh(water, b.add(DielectricMaterial{static_cast<float>(eta)}));
        b.scene.lights.push_back(PointLight{white_light(b.scene),
                                            static_cast<float>(intensity) * white_scale(),
                                            {0, 0, static_cast<float>(depth + height)}});
        b.look({0.3, 0, 0.8}, {0, 0, 0}, 0.1f); // from below the water
        SceneDescription d = sampled(b);
        d.integrator.max_depth = 2;
        d.sampler.spp = 256;
        const PictureMean mean = picture_mean(render(d));
        const double lost = std::pow((eta - 1) / (eta + 1), 2);
        const double distance = height + depth / eta;
        const double expected = albedo / pi * (1 - lost) * intensity / (distance * distance);
        EXPECT_LT(std::abs(mean.mean - expected), 5 * mean.standard_error + 1e-3 * expected)
            << mean.mean << " " << expected;
        EXPECT_LT(mean.standard_error, 0.02 * expected);
    }
}

// A spot of a floor beside a mirror: the light and its image, each alone. The mirror is a plate of the given thickness.
PictureMean beside_a_plate(double thickness, Vec3d moved) {
    SceneBuilder b;
    const Transform t = Transform::translate(moved);
    b.add_mesh(square(t * Transform::scale({6, 6, 1})), b.add(DiffuseMaterial{gray(0.8f)}));
    TriangleMesh plate;
    for (const double x : {2.0, 2 + thickness})
        for (const double y : {-3.0, 3.0})
            for (const double z : {-3.0, 3.0}) plate.positions.push_back(Vec3f(t.point(Vec3d{x, y, z})));
    plate.indices = {0, 1, 3, 0, 3, 2, 4, 7, 5, 4, 6, 7}; // normals point away from each other
    b.add_mesh(plate, b.add(perfect_mirror()));
    b.scene.lights.push_back(
        PointLight{white_light(b.scene), 3 * white_scale(), Vec3f(t.point(Vec3d{1.5, 0, 1}))});
    b.look(t.point(Vec3d{0, 0, 1}), t.point(Vec3d{0.3, 0, 0}), 0.1f);
    SceneDescription d = sampled(b);
    d.integrator.max_depth = 2;
    d.sampler.spp = 64;
    return picture_mean(render(d));
}

TEST(ManifoldSampling, ThinPlatesReflectOnce) {
    const auto brightness = [](double across) { // of the floor; 1 below the light
        const double squared = across * across + 1;
        return 1 / (squared * std::sqrt(squared));
    };
    const double expected = 0.8 / pi * 3 * (brightness(1.2) + brightness(2.2));
    for (const Vec3d moved : {Vec3d{}, Vec3d{300, -100, 200}, Vec3d{4096, 1024, -2048}})
        for (const double thickness : {1e-5, 1e-4, 1e-3, 0.1}) {
            if (thickness < 0.1 && moved.x > 1000) continue; // less than positions can tell
            const PictureMean mean = beside_a_plate(thickness, moved);
            EXPECT_LT(std::abs(mean.mean - expected), 5 * mean.standard_error + 2e-3 * expected)
                << moved.x << " " << thickness << ": " << mean.mean << " " << expected;
            EXPECT_LT(mean.standard_error, 0.01 * expected);
        }
}

void add_waves(SceneBuilder& b, double height, double slope, const Material& m) {
    b.add_mesh(wavy_mesh(slope, 10, Transform::translate({0, 0, height}) * Transform::scale({1.4, 1.4, 1})),
               b.add(m));
}
void add_ball(SceneBuilder& b, const Material& m, Vec3d at = {-0.3, -0.3, 0.5}, double radius = 0.35) {
    b.add_quadric(
        Sphere{.world_from_object = Transform::translate(at) * Transform::scale({radius, radius, radius})},
        b.add(m));
}
void add_point_light(SceneBuilder& b, Vec3f at = {0.4f, -0.5f, 1.5f}) {
    b.scene.lights.push_back(PointLight{white_light(b.scene), 4 * white_scale(), at});
}

struct Case {
    std::string name;
    SceneBuilder scene;
    std::uint32_t samples = 64; // per pixel and seed, of either method
};

// Against `reference`, without manifold sampling.
void expect_sampling_agrees(const std::vector<Case>& cases, IntegratorKind reference, double most_error,
                            double most_ratio) {
    expect_pooled_agreement(
        cases,
        [&](const Case& c, std::size_t i) {
            SceneDescription plain = c.scene.description;
            plain.sampler.seed = 3000 + 1000 * i;
            SceneDescription d = sampled(c.scene);
            d.sampler.seed = 90'000 + 1000 * i;
            return agreement_of(render_of_seeds(plain, reference, c.samples),
                                render_of_seeds(d, IntegratorKind::path, c.samples));
        },
        most_error, most_ratio);
}

// Lamps that scattering finds as well. Nothing is counted twice or left out.
std::vector<Case> lamps() {
    std::vector<Case> cases;
    const auto add = [&](const char* name, SceneBuilder b, const auto& change, std::uint32_t samples = 64) {
        change(b);
        cases.push_back({name, b, samples});
    };
    SceneBuilder corner = lit_corner();
    add_box_lamp(corner, 0.6);
    add("mirror ball", corner, [](SceneBuilder& b) { add_ball(b, perfect_mirror()); });
    add("glass ball", corner, [](SceneBuilder& b) { add_ball(b, DielectricMaterial{1.5f}); });
    add("tinted glass", corner, [](SceneBuilder& b) {
        DielectricMaterial m{1.5f};
        m.specular_reflectance = gray(0.5f);
        m.specular_transmittance = gray(0.8f);
        add_ball(b, m);
    });
    add("facets", corner, [](SceneBuilder& b) {
        TriangleMesh facets =
            wavy_mesh(0.3, 4, Transform::translate({-0.1, 0.9, 0.6}) * Transform::rotate(80, {1, 0, 0}));
        facets.normals.clear();
        b.add_mesh(facets, b.add(ConductorMaterial{}));
    });
    add(
        "water", corner, [](SceneBuilder& b) { add_waves(b, 0.5, 0.1, DielectricMaterial{1.33f}); }, 192);
    add("lamp under water", corner, [](SceneBuilder& b) {
        add_waves(b, 0.7, 0.1, DielectricMaterial{1.33f});
        b.add_quadric(Sphere{.world_from_object = Transform::translate({0.3, -0.3, 0.35}) *
                                                  Transform::scale({0.25, 0.25, 0.25})},
                      b.add(DiffuseMaterial{gray(0)}), 3);
    });
    for (const int depth : {1, 2, 3})
        add(("depth " + std::to_string(depth)).c_str(), corner, [&](SceneBuilder& b) {
            add_ball(b, perfect_mirror());
            b.description.integrator.max_depth = depth;
        });
    // Vertices with other lobes, and casters that are left to scattering.
    SceneBuilder shiny = lit_corner(CoatedDiffuseMaterial{
        gray(0.6f), CoatingParameters{.roughness = alpha_of(0), .eta = 1.5f, .albedo = gray(0), .g = {0}}});
    add_box_lamp(shiny, 0.6);
    add("smooth coat", shiny, [](SceneBuilder& b) { add_ball(b, perfect_mirror()); });
    SceneBuilder metal = lit_corner(
        ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(3)}, .roughness = alpha_of(0.4f)});
    add_box_lamp(metal, 0.6);
    add("rough metal", metal, [](SceneBuilder& b) { add_ball(b, perfect_mirror()); });
    add(
        "flint", corner,
        [](SceneBuilder& b) {
            const Spectrum flint(PiecewiseLinear::from_pairs(std::array{360.0f, 1.8f, 830.0f, 1.5f}));
            add_ball(b, DielectricMaterial{add_spectrum(b.scene, flint)});
            add_ball(b, perfect_mirror(), {0.6, -0.3, 0.4}, 0.3);
        },
        320);
    add("two sides and a sky", corner, [](SceneBuilder& b) {
        std::get<AreaLight>(b.scene.lights[0]).two_sided = true;
        b.add_uniform_light(0.3f);
        add_ball(b, perfect_mirror());
        add_ball(b, DielectricMaterial{1.5f}, {0.6, -0.3, 0.4}, 0.3);
    });
    add("sky", lit_corner(), [](SceneBuilder& b) {
        b.add_uniform_light(1);
        add_box_lamp(b, 0.6);
        b.add_mesh(square(Transform::translate({1.2, 0, 1}) * Transform::rotate(90, {0, 1, 0}) *
                          Transform::scale({1.5, 1.5, 1})),
                   b.add(perfect_mirror()));
    });
    add("sun", lit_corner(), [](SceneBuilder& b) {
        SunLight sun;
        sun.spectrum = white_light(b.scene);
        sun.scale = 2 * white_scale();
        sun.disc = SunDisc::of_radius(normalize(Vec3f{0.3f, -0.8f, 1}), 0.35);
        b.scene.lights.push_back(sun);
        add_ball(b, perfect_mirror());
    });
    add("Sobol' points", corner, [](SceneBuilder& b) {
        b.description.sampler.kind = SamplerKind::sobol;
        add_ball(b, perfect_mirror());
        add_ball(b, DielectricMaterial{1.5f}, {0.6, -0.3, 0.4}, 0.3);
    });
    return cases;
}

TEST(ManifoldSampling, AgreesWithPathTracing) {
    expect_sampling_agrees(lamps(), IntegratorKind::path, 0.03, 1.1);
}

// Lights that path tracing cannot find across a caster. As long as the depth allows one specular vertex only, paths
// from the lights and manifold sampling find the same light.
std::vector<Case> points() {
    std::vector<Case> cases;
    const auto add = [&](const std::string& name, SceneBuilder b, const auto& change,
                         std::uint32_t samples = 48) {
        change(b);
        b.description.integrator.max_depth = 2;
        cases.push_back({name, b, samples});
    };
    add("ball", lit_corner(), [](SceneBuilder& b) {
        add_point_light(b);
        add_ball(b, perfect_mirror());
    });
    add("spot", lit_corner(), [](SceneBuilder& b) {
        SpotLight spot;
        spot.spectrum = white_light(b.scene);
        spot.scale = 9 * white_scale();
        spot.position = {0.5f, -1, 2};
        spot.axis = normalize(Vec3f(-0.5f, 0.5f, -1.2f));
        spot.cos_falloff_start = 0.95f;
        spot.cos_total_width = 0.8f;
        b.scene.lights.push_back(spot);
        add_ball(b, ConductorMaterial{});
    });
    add("distant", lit_corner(), [](SceneBuilder& b) {
        b.scene.lights.push_back(
            DistantLight{white_light(b.scene), 2 * white_scale(), normalize(Vec3f(0.3f, -1, 1))});
        add_ball(b, perfect_mirror());
    });
    // Several solutions at once: a bowl, whose caustic has a cusp, and waves.
    add("bowl", lit_corner(), [](SceneBuilder& b) {
        add_point_light(b, {0.1f, -0.2f, 0.9f});
        TriangleMesh bowl;
        constexpr int cells = 8;
        for (int j = 0; j <= cells; ++j)
            for (int i = 0; i <= cells; ++i) {
                const double x = 1.6 * i / cells - 0.8, z = 1.2 * j / cells;
                bowl.positions.push_back(Vec3f(Vec3d{x, 0.9 - 0.6 * x * x, z}));
                bowl.normals.push_back(Vec3f(normalize(Vec3d{-1.2 * x, -1, 0})));
            }
        for (Index j = 0; j < cells; ++j)
            for (Index i = 0; i < cells; ++i) {
                const Index a = j * (cells + 1) + i, c = a + cells + 1;
                for (const Index k : {a, a + 1, c + 1, a, c + 1, c}) bowl.indices.push_back(k);
            }
        b.add_mesh(bowl, b.add(perfect_mirror()));
    });
    add("mirror waves", lit_corner(), [](SceneBuilder& b) {
        add_point_light(b);
        b.add_mesh(wavy_mesh(0.15, 10, Transform::translate({0, 1, 0.6}) * Transform::rotate(90, {1, 0, 0})),
                   b.add(perfect_mirror()));
    });
    // The camera is in the water.
    const auto add_water = [](SceneBuilder& b) {
        add_point_light(b, {0.4f, -0.5f, 4.5f});
        b.add_mesh(wavy_mesh(0.1, 10, Transform::translate({0, -1, 3}) * Transform::scale({5, 5, 1})),
                   b.add(DielectricMaterial{1.33f}));
    };
    add("waves from below", lit_corner(), add_water, 96);
    return cases;
}

TEST(ManifoldSampling, AgreesWithBidirectional) {
    expect_sampling_agrees(points(), IntegratorKind::bidirectional, 0.03, 1.1);
}

SceneBuilder small_scene() {
    SceneBuilder b = lit_corner();
    add_box_lamp(b, 0.2);
    add_point_light(b);
    add_ball(b, DielectricMaterial{1.5f});
    add_waves(b, 1.2, 0.1, DielectricMaterial{1.33f});
    b.description.sampler.spp = under_sanitizers ? 4 : 16;
    return b;
}

TEST(ManifoldSampling, AnyNumberOfThreads) {
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        SceneDescription d = sampled(small_scene());
        d.sampler.kind = kind;
        std::vector<Film> films;
        for (const int threads : {1, 2, 7}) with_threads(threads, [&] { films.push_back(render(d)); });
        for (std::size_t s = 1; s < films.size(); ++s)
            for (std::size_t i = 0; i < films[0].pixels().size(); ++i)
                ASSERT_TRUE(same_pixel(films[0].pixels()[i], films[s].pixels()[i]));
    }
}

TEST(ManifoldSampling, InterruptedRendersEndWithTheSameBits) {
    TemporaryFolder folder;
    SceneDescription d = sampled(small_scene());
    const auto prepared = prepared_scene(d);
    const Film whole = render(d, prepared);
    const Pieces pieces = render_in_pieces(d, folder / "sampled.state", 64 * d.sampler.spp, prepared);
    EXPECT_GT(pieces.count, 2);
    for (std::size_t i = 0; i < whole.pixels().size(); ++i)
        ASSERT_TRUE(same_pixel(whole.pixels()[i], pieces.state.film.pixels()[i]));
    d.integrator.manifold_sampling = false;
    EXPECT_THROW(load_checkpoint(folder / "sampled.state", d, {}), Error);
}

SceneBuilder lamp_without_casters() {
    SceneBuilder b = lit_corner();
    add_box_lamp(b);
    return b;
}
SceneBuilder mirror_without_lamps() {
    SceneBuilder b = lit_corner();
    b.add_uniform_light(1);
    add_ball(b, perfect_mirror());
    return b;
}

// Without a pair of a caster and a light the bits are those of path tracing.
TEST(ManifoldSampling, ChangesNothingWithoutCasters) {
    const SceneBuilder lamp = lamp_without_casters(), sky = mirror_without_lamps();
    for (const SceneBuilder* b : {&lamp, &sky}) {
        const Film plain = render(b->description), other = render(sampled(*b));
        for (std::size_t i = 0; i < plain.pixels().size(); ++i)
            ASSERT_TRUE(same_pixel(plain.pixels()[i], other.pixels()[i]));
    }
}

// The warning names what is missing: a caster or a light.
TEST(ManifoldSampling, WithoutEffectAWarningSaysWhy) {
    const SceneBuilder lamp = lamp_without_casters(), sky = mirror_without_lamps();
    SceneBuilder both = lamp_without_casters();
    add_ball(both, perfect_mirror());
    const auto warning = [](const SceneDescription& d) { return manifold_warning(Renderer(d)); };
    EXPECT_NE(warning(sampled(lamp)).find("no effect: no shape"), std::string::npos);
    EXPECT_NE(warning(sampled(sky)).find("no effect: no light"), std::string::npos);
    EXPECT_EQ(warning(sampled(both)), "");
    EXPECT_EQ(warning(sky.description), "");
}

TEST(ManifoldSampling, RefusesWhatItCannotRender) {
    const auto message = [](const auto& change) {
        SceneDescription d = sampled(small_scene());
        change(d);
        try {
            render(d);
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_EQ(message([](SceneDescription&) {}), "");
    const auto says = [&](const char* word, const auto& change) {
        EXPECT_NE(message(change).find(word), std::string::npos) << word << ": " << message(change);
    };
    says("bidirectional", [](SceneDescription& d) { d.integrator.method = IntegratorKind::bidirectional; });
    says("metropolis", [](SceneDescription& d) { d.integrator.method = IntegratorKind::metropolis; });
    says("ambient", [](SceneDescription& d) { d.integrator.occlusion.emplace(); });
    says("learn", [](SceneDescription& d) { d.integrator.guiding = Guiding::automatic; });
    says("mis", [](SceneDescription& d) { d.integrator.strategy = Strategy::light; });
    says("regularization", [](SceneDescription& d) { d.integrator.regularize = true; });
    says("terminator",
         [](SceneDescription& d) { d.integrator.shading_terminator = ShadingTerminator::soft; });
    says("media", [](SceneDescription& d) { d.scene.media.push_back(HomogeneousMedium{}); });
}

} // namespace
} // namespace montelux::testing
