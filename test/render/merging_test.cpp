// Merging as a render: known answers, agreement with path tracing, the bias and its estimate, memory, and that the picture
// depends on scene and seed alone.
#include "test/render/agreement.h"
#include "test/render/mixed_scene.h"
#include "test/render/render_in_pieces.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/merging_bias.h"
#include "montelux/render/render_session.h"
#include "montelux/render/render_warnings.h"
#include "montelux/render/sample_context.h"
#include "montelux/render/splat_pass.h"

namespace montelux::testing {
namespace {

SeedMeans merged(SceneDescription d, float radius, std::uint32_t spp, int count = bidirectional_seeds) {
    d.integrator.merging = MergingSettings{.radius = radius};
    return render_of_seeds(d, IntegratorKind::bidirectional, spp, count);
}

constexpr float metal_eta = 0.2f, metal_k = 3;
constexpr double intensity = 20, floor_albedo = 0.5;

// A spot shines up at a mirror, which throws its beam down to the floor at 45 degrees; the camera sees the floor in
// another mirror. Only merging finds the light.
SceneBuilder beam_in_mirrors(double fov, int width = 8) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = width;
    b.description.film.crop = {0, 0, width, width};
    b.description.integrator.max_depth = 3;
    const ConductorMaterial mirror{.metal = {.eta = gray(metal_eta), .k = gray(metal_k)},
                                   .roughness = alpha_of(0)};
    b.add_mesh(square(Transform::scale({3, 3, 1})), b.add(DiffuseMaterial{gray(float(floor_albedo))}));
    const Index metal = b.add(mirror);
    b.add_mesh(square(Transform::translate({-2, 0, 2}) * Transform::rotate(180, {1, 0, 0})), metal);
    b.add_mesh(square(Transform::translate({1.5, 0, 1}) * Transform::rotate(-90, {0, 1, 0})), metal);
    SpotLight spot;
    spot.spectrum = white_light(b.scene);
    spot.scale = float(intensity) * white_scale();
    spot.position = {-3, 0, 1};
    spot.axis = normalize(Vec3f(1, 0, 1));
    spot.cos_falloff_start = std::cos(0.1f);
    spot.cos_total_width = std::cos(0.25f);
    b.scene.lights.push_back(spot);
    b.look({-1, 0, 1}, {3, 0, 0}, fov);
    return b;
}
double reflectance(double cosine) {
    using Complex = std::complex<double>;
    const Complex eta = Complex{metal_eta, metal_k}, e2 = eta * eta,
                  root = std::sqrt(e2 - (1 - cosine * cosine));
    return 0.5 * (std::norm((cosine - root) / (cosine + root)) +
                  std::norm((e2 * cosine - root) / (e2 * cosine + root)));
}
// Of the middle of the beam, from the light's image at (-3, 0, 3).
double truth_of_beam() {
    const double cosine = std::sqrt(0.5);
    return floor_albedo / std::numbers::pi * intensity * reflectance(cosine) *
           reflectance(4 / std::sqrt(17.0)) * cosine / 18;
}

TEST(MergingPictures, BeamInMirrorsInClosedForm) {
    SceneBuilder b = beam_in_mirrors(2);
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        b.description.integrator.heuristic =
            kind == SamplerKind::sobol ? Heuristic::power : Heuristic::balance;
        const SeedMeans m = merged(b.description, 0.15f, 160);
        const RunningMoments& green = m.channel[1];
        EXPECT_LT(green.standard_error(), 0.015 * green.mean());
        EXPECT_NEAR(green.mean(), truth_of_beam(), 7 * green.standard_error() + 0.004 * truth_of_beam())
            << int(kind);
    }
    const SeedMeans unmerged = render_of_seeds(b.description, IntegratorKind::bidirectional, 16, 2);
    EXPECT_EQ(unmerged.channel[1].mean(), 0);
}

// Scenes of any size have the same picture.
TEST(MergingPictures, FurnaceAtAnyScale) {
    for (const double scale : {1e-3, 1.0, 1e4}) {
        SceneBuilder b;
        b.add_quadric(Sphere{.world_from_object = Transform::scale({scale, scale, scale})},
                      b.add(DiffuseMaterial{gray(0.5f)}), 1, true);
        b.look(scale * Vec3d{0.2, 0.1, -0.3}, scale * Vec3d{1, 0, 0}, 60);
        const int depth = scale == 1 ? 2 : 200;
        b.description.integrator.max_depth = depth;
        const double truth = 2 - std::pow(0.5, depth);
        const SeedMeans m = merged(b.description, float(0.1 * scale), 24);
        // On the sphere a ball of the radius contains a little less than the disc, and its chords point elsewhere.
        EXPECT_NEAR(m.channel[1].mean(), truth, 7 * m.channel[1].standard_error() + 3e-3 * truth)
            << scale << ' ' << depth;
    }
}

// Facets of a ball with its normals: light falls on neighbouring ones at angles that are far apart.
TriangleMesh smooth_icosahedron(const Transform& place) {
    const float g = std::numbers::phi_v<float>;
    TriangleMesh mesh;
    for (const float a : {-1.0f, 1.0f})
        for (const float b : {-g, g})
            for (const Vec3f& v : {Vec3f{0, a, b}, Vec3f{a, b, 0}, Vec3f{b, 0, a}}) {
                mesh.positions.push_back(Vec3f(place.point(Vec3d(normalize(v)))));
                mesh.normals.push_back(normalize(v));
            }
    const auto near = [&](Index i, Index j) { return dot(mesh.normals[i], mesh.normals[j]) > 0.4f; };
    for (Index i = 0; i < 12; ++i)
        for (Index j = i + 1; j < 12; ++j)
            for (Index k = j + 1; k < 12; ++k)
                if (near(i, j) && near(j, k) && near(i, k)) {
                    const Vec3f a = mesh.normals[i], b = mesh.normals[j], c = mesh.normals[k];
                    const bool outward = dot(cross(b - a, c - a), a) > 0;
                    mesh.indices.insert(mesh.indices.end(), {i, outward ? j : k, outward ? k : j});
                }
    return mesh;
}

// Inside a lamp that reflects, so that light comes from all sides, and by many light paths: nearly all of it is merged.
TEST(MergingPictures, FacetsOfSmoothMeshesAreLitAsByPaths) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 24;
    b.description.film.crop = {0, 0, 24, 24};
    b.description.integrator.max_depth = 2;
    b.add_quadric(Sphere{}, b.add(DiffuseMaterial{gray(0.9f)}), 1, true);
    b.add_mesh(smooth_icosahedron(Transform::scale({0.3, 0.3, 0.3})), b.add(DiffuseMaterial{gray(0.8f)}));
    b.look({0.9, 0, 0}, {0, 0, 0}, 20);
    const RunningMoments plain = render_of_seeds(b.description, IntegratorKind::bidirectional, 16).channel[1],
                         m = merged(b.description, 0.1f, 64)
                                 .channel[1]; // passes share wavelengths: it takes more of them
    const double error = std::hypot(plain.standard_error(), m.standard_error());
    EXPECT_LT(error, 2e-3 * plain.mean());
    EXPECT_NEAR(m.mean(), plain.mean(), 7 * error + 5e-3 * plain.mean());
}

TEST(MergingPictures, AgreesWithPathTracing) {
    std::vector<AgreementCase> cases;
    const auto add = [&](const char* name, const SceneBuilder& b, std::uint32_t samples = 32) {
        cases.push_back({.name = name, .scene = b, .samples = samples});
    };
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
        SceneBuilder room = mixed_scene(1, 8, 8);
        room.description.integrator.heuristic = heuristic;
        add("room", room);
    }
    SceneBuilder lens = lit_corner();
    add_box_lamp(lens);
    lens.scene.camera.model = PerspectiveCamera{.fov = 40, .lens_radius = 0.1f, .focal_distance = 3};
    add("thin lens", lens);
    SceneBuilder sky = lit_corner();
    sky.add_uniform_light(0.7f);
    add("sky", sky);
    SceneBuilder normals = lit_corner();
    add_box_lamp(normals);
    TriangleMesh bent = square(Transform::translate({-0.2, -0.2, 0.3}) * Transform::rotate(25, {0, 1, 0}) *
                               Transform::scale({0.6, 0.6, 1}));
    bent.normals = {{-0.3f, -0.1f, 1}, {0.4f, 0, 1}, {0.3f, 0.3f, 1}, {-0.2f, 0.3f, 1}};
    normals.add_mesh(bent, normals.add(DiffuseMaterial{gray(0.8f)}));
    add("shading normals", normals);
    const Spectrum flint(PiecewiseLinear::from_pairs(std::array{360.0f, 1.8f, 830.0f, 1.5f}));
    SceneBuilder glass = lit_corner();
    add_box_lamp(glass);
    glass.add_quadric(Sphere{.radius = 0.4f,
                             .z_min = -0.4f,
                             .z_max = 0.4f,
                             .world_from_object = Transform::translate({0.2, 0, 0.5})},
                      glass.add(DielectricMaterial{add_spectrum(glass.scene, flint), alpha_of(0.3f)}));
    add("dispersive glass", glass, 64);
    double squares = 0, pixels = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        SceneDescription d = cases[i].scene.description;
        d.sampler.seed = 1000 * i;
        const std::uint32_t samples = cases[i].samples;
        const Agreement r =
            agreement_of(render_of_seeds(d, IntegratorKind::path, samples), merged(d, 0.06f, samples));
        EXPECT_LT(r.error, 0.06) << cases[i].name;
        EXPECT_LT(r.bias, 7 * r.error + 0.004) << cases[i].name;
        squares += r.squares;
        pixels += r.pixels;
    }
    // The pixels differ by as much as their errors say: these cover the noise.
    EXPECT_GT(std::sqrt(squares / pixels), 0.9);
    EXPECT_LT(std::sqrt(squares / pixels), 1.15);
}

// Of the two pictures, over cells of 16 x 16 pixels.
double rms_difference(const Film& a, const Film& b, int width) {
    constexpr int cell = MergingBias::cell;
    double squares = 0;
    for (int y = 0; y < width; y += cell)
        for (int x = 0; x < width; x += cell) {
            double sum = 0;
            for (int i = 0; i < cell * cell; ++i)
                sum += a.pixel(x + i % cell, y + i / cell).replicates().mean(1) -
                       b.pixel(x + i % cell, y + i / cell).replicates().mean(1);
            squares += sum * sum;
        }
    return std::sqrt(squares * cell * cell) / (double(width) * cell * cell);
}

// The whole beam and its rim: a wide disc blurs it. The bias falls as the square of the radius, and is known.
TEST(MergingPictures, BiasFallsWithTheRadiusAndIsEstimated) {
    constexpr int width = 48;
    SceneBuilder b = beam_in_mirrors(25, width);
    b.description.integrator.method = IntegratorKind::bidirectional;
    const auto render_with = [&](float radius, std::uint32_t spp) {
        SceneDescription d = b.description;
        d.sampler.spp = spp;
        d.sampler.seed = spp;
        d.integrator.merging = MergingSettings{.radius = radius};
        RenderState state(d);
        Renderer(d).render(state);
        return state;
    };
    const RenderState truth = render_with(0.08f, 96);
    double last = 0;
    for (const float radius : {0.8f, 0.4f}) {
        const RenderState state = render_with(radius, 48);
        const MergingSummary& m = state.report.merging;
        const double bias = rms_difference(state.film, truth.film, width);
        EXPECT_EQ(m.first_radius, double(radius));
        EXPECT_NEAR(m.last_radius, double(radius) * std::pow(48, -0.125), 1e-6);
        EXPECT_EQ(m.passes, 48u);
        EXPECT_GT(m.bias_rms, 0.6 * bias) << radius;
        EXPECT_LT(m.bias_rms, 1.6 * bias) << radius;
        if (last > 0) {
            EXPECT_LT(bias, 0.45 * last);
            EXPECT_GT(bias, 0.1 * last);
        }
        last = bias;
    }
}

// Passes of known bias: their mean, its standard error, and the mean square over cells without that of the noise.
TEST(MergingBias, IsTheMeanOfThePasses) {
    constexpr double samples = 4, pixels = MergingBias::cell * MergingBias::cell;
    for (const int passes : {2, 3}) {
        // Two cells, of which the right one stays without bias.
        MergingBias bias({8, 4, 8 + 2 * MergingBias::cell, 4 + MergingBias::cell});
        for (int pass = 0; pass < passes; ++pass) {
            // The left cell's bias is 2, 6, 10: twice what half the area loses.
            const double loss = (1 + 2 * pass) * samples * pixels;
            bias.add(8 + pass, 5, Vec3d{-loss, -loss, -loss});
            bias.add(9, 6 + pass, Vec3d{0, 0, 0});
            bias.close_pass(samples);
        }
        const double mean = passes == 2 ? 4 : 6, squared_error = passes == 2 ? 4 : 16.0 / 3;
        const MergingBias::Estimate e = bias.estimate();
        EXPECT_NEAR(e.mean, mean / 2, 1e-5);
        EXPECT_NEAR(e.error, std::sqrt(squared_error) / 2, 1e-5);
        EXPECT_NEAR(e.rms, std::sqrt((mean * mean - squared_error) / 2), 1e-5);
    }
}

int differing(const Film& a, const Film& b) {
    int n = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) n += !same_pixel(a.pixels()[i], b.pixels()[i]);
    return n;
}

SceneBuilder merging_room(int width, int height) {
    SceneBuilder b = mixed_scene(1, width, height);
    b.description.integrator.method = IntegratorKind::bidirectional;
    b.description.integrator.merging = MergingSettings{};
    b.description.film.filter = GaussianFilter{};
    return b;
}

bool same(const MergingSummary& a, const MergingSummary& b) {
    return a.first_radius == b.first_radius && a.last_radius == b.last_radius && a.bias == b.bias &&
           a.bias_error == b.bias_error && a.bias_rms == b.bias_rms && a.bytes == b.bytes &&
           a.passes == b.passes;
}

TEST(MergingPictures, AnyNumberOfThreadsGivesTheSameBits) {
    SceneBuilder b = merging_room(40, 24);
    b.description.sampler.spp = under_sanitizers ? 2 : 6;
    const auto prepared = prepared_scene(b.description);
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        b.description.sampler.replicates = kind == SamplerKind::sobol ? 2 : 0;
        std::vector<RenderState> states;
        for (const int threads : {1, 2, 7})
            with_threads(threads, [&] {
                RenderState& state = states.emplace_back(b.description);
                Renderer(b.description, {}, 0, prepared).render(state);
            });
        for (std::size_t i = 1; i < states.size(); ++i) {
            EXPECT_EQ(differing(states[0].film, states[i].film), 0) << int(kind);
            EXPECT_TRUE(same(states[0].report.merging, states[i].report.merging));
        }
        EXPECT_GT(states[0].report.merging.bias_error, 0);
    }
}

// Interrupted within passes, saved, and resumed: the map of the pass is built again.
TEST(MergingPictures, ResumedRendersHaveTheSameBits) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "render.state";
    SceneBuilder b = merging_room(40, 24);
    const auto prepared = prepared_scene(b.description);
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        b.description.sampler.spp = under_sanitizers ? 6 : 12;
        RenderState whole(b.description);
        Renderer(b.description, {}, 0, prepared).render(whole);
        const Pieces pieces = render_in_pieces(b.description, path, whole.report.samples, prepared);
        EXPECT_EQ(differing(pieces.state.film, whole.film), 0) << int(kind);
        EXPECT_TRUE(same(pieces.state.report.merging, whole.report.merging)) << int(kind);
        EXPECT_GT(pieces.count, 2);
        EXPECT_GT(pieces.begun_within_a_pass, 0);
        // A render that merges otherwise is another one.
        SceneDescription other = b.description;
        other.integrator.merging->radius = 0.5f;
        EXPECT_THROW(load_checkpoint(path, other, {}), Error);
        other.integrator.merging.reset();
        EXPECT_THROW(load_checkpoint(path, other, {}), Error);
    }
}

// Light paths depend on the seed and the pixel as camera paths do.
TEST(MergingPictures, SeedsAndPixelsHaveOtherLightPaths) {
    SceneBuilder b = beam_in_mirrors(25);
    b.description.integrator.method = IntegratorKind::bidirectional;
    b.description.integrator.merging = MergingSettings{.radius = 0.1f};
    const auto first_vertex = [&](std::uint64_t seed, const SampleContext::Key& key) {
        b.description.sampler.seed = seed;
        const Renderer renderer(b.description);
        const SampleContext context(b.description, renderer.sampler(), renderer.scene(), renderer.camera());
        RayTracer tracer(renderer.accelerator());
        LightPaths paths;
        context.trace_light(tracer, std::span(&key, 1), paths);
        EXPECT_FALSE(paths.vertices.empty()); // the spot shines at a mirror
        return paths.vertices.empty() ? Vec3f() : Vec3f(paths.vertices.front().p);
    };
    const auto same_place = [](Vec3f p, Vec3f q) { return length(p - q) == 0; };
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        const Vec3f place = first_vertex(1, {3, 5, 7});
        EXPECT_TRUE(same_place(first_vertex(1, {3, 5, 7}), place));
        EXPECT_FALSE(same_place(first_vertex(2, {3, 5, 7}), place));
        EXPECT_FALSE(same_place(first_vertex(1, {4, 5, 7}), place));
        EXPECT_FALSE(same_place(first_vertex(1, {3, 6, 7}), place));
        EXPECT_FALSE(same_place(first_vertex(1, {3, 5, 8}), place));
    }
}

// A sample has one map, whichever slice takes it.
TEST(MergingPictures, SlicesTakeTheSamplesOfTheWhole) {
    SceneBuilder b = merging_room(16, 12);
    b.description.sampler.spp = 4;
    const auto prepared = prepared_scene(b.description);
    const Film whole = render(b.description, prepared);
    std::vector<Film> parts;
    for (const std::uint32_t index : {0u, 1u}) {
        RenderTarget target;
        target.slice = {index, 2};
        RenderState state(b.description);
        Renderer(b.description, target, 0, prepared).render(state);
        parts.push_back(std::move(state.film));
    }
    for (std::size_t i = 0; i < whole.pixels().size(); ++i) {
        const double mean = whole.pixels()[i].replicates().mean(1);
        EXPECT_NEAR(
            mean,
            0.5 * (parts[0].pixels()[i].replicates().mean(1) + parts[1].pixels()[i].replicates().mean(1)),
            1e-9 + 1e-6 * mean);
    }
}

// Fewer light paths merge where their map would be too large; what they bring stays right.
TEST(MergingPictures, MemoryIsBounded) {
    SceneBuilder b = beam_in_mirrors(2, 160);
    b.description.integrator.method = IntegratorKind::bidirectional;
    b.description.integrator.merging = MergingSettings{.radius = 0.1f, .memory = 1};
    b.description.sampler.spp = 4;
    RenderState state(b.description);
    Renderer(b.description).render(state);
    const MergingSummary& m = state.report.merging;
    EXPECT_EQ(m.of_paths, 160u * 160u);
    EXPECT_LT(m.light_paths, m.of_paths);
    EXPECT_LE(m.bytes, 1u << 20);
    EXPECT_GT(m.bytes, 3u << 18);
    EXPECT_NEAR(picture_mean(state.film).mean, truth_of_beam(), 0.03 * truth_of_beam());
}

std::string refusal_of(const SceneDescription& d, const RenderTarget& target = {}) {
    try {
        RenderState state(d);
        Renderer(d, target).render(state);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(MergingPictures, RefusesWhatItCannotDo) {
    SceneBuilder room = merging_room(8, 8);
    room.description.sampler.spp = 1;
    EXPECT_EQ(refusal_of(room.description), "");
    const auto expect_refused = [&](const std::function<void(SceneDescription&)>& change, const char* word) {
        SceneDescription d = room.description;
        change(d);
        EXPECT_NE(refusal_of(d).find(word), std::string::npos) << word << ": " << refusal_of(d);
    };
    for (const IntegratorKind kind :
         {IntegratorKind::path, IntegratorKind::light_tracing, IntegratorKind::metropolis})
        expect_refused([&](auto& d) { d.integrator.method = kind; }, "only the integrator 'bidirectional'");
    expect_refused([](auto& d) { d.integrator.merging->radius = -1; }, "radius");
    expect_refused([](auto& d) { d.integrator.merging->radius = std::nanf(""); }, "radius");
    expect_refused([](auto& d) { d.integrator.merging->radius = 1e-9f; }, "too small");
    expect_refused([](auto& d) { d.integrator.merging->radius = 100; }, "too large");
    expect_refused([](auto& d) { d.integrator.merging->memory = 0; }, "memory");
    EXPECT_NE(refusal_of(room.description, {.adaptive = true}).find("--adaptive"), std::string::npos);
}

// Frames of an animation may be dark, or show mirrors alone.
TEST(MergingPictures, WhereNothingMergesAWarningSaysSo) {
    SceneBuilder shallow = merging_room(8, 8), mirrors = merging_room(8, 8), dark = lit_corner();
    shallow.description.integrator.max_depth = 1;
    for (Material& m : mirrors.description.scene.materials)
        m = ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(3)}, .roughness = alpha_of(0)};
    dark.description.integrator = mirrors.description.integrator; // and no lamp
    for (SceneBuilder* b : {&shallow, &mirrors, &dark}) {
        b->description.sampler.spp = 64;
        RenderState state(b->description);
        Renderer(b->description).render(state);
        EXPECT_NE(merging_warning(state.report.merging).find("no effect"), std::string::npos);
        RenderSnapshot result;
        result.report = state.report;
        EXPECT_EQ(merging_notice(result, {}), "");
        b->description.integrator.merging.reset();
        const PictureMean mean = picture_mean(state.film), plain = picture_mean(render(b->description));
        EXPECT_EQ(mean.mean > 0, b != &dark);
        EXPECT_LE(std::abs(mean.mean - plain.mean),
                  5 * std::hypot(mean.standard_error, plain.standard_error));
    }
    SceneBuilder room = merging_room(8, 8);
    room.description.sampler.spp = 2;
    RenderState state(room.description);
    Renderer(room.description).render(state);
    EXPECT_EQ(merging_warning(state.report.merging), "");
}

} // namespace
} // namespace montelux::testing
