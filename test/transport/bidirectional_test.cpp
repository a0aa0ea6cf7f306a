// The weights of bidirectional path tracing: densities found on the way against those computed anew from the vertices
// of the path, and the sum over all strategies.
#include "test/transport/path_densities.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/scene/bsdf/diffuse.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/transport/bidirectional_sample.h"

namespace montelux::testing {
namespace {

struct Counts {
    const SceneView* scene;
    const Camera* camera;
    Heuristic heuristic;
    int paths = 0, off_weights = 0, off_densities = 0, off_sums = 0, in_media = 0;
    std::array<int, 12> of_strategy{}; // min(s, 2), min(t, 2)
    std::vector<double> scratch{};

    void count(const FoundPath& found) {
        ++of_strategy[4 * std::min<std::size_t>(found.s, 2) + std::min<std::size_t>(found.t, 2)];
        if (found.s + found.t == 2) return;
        ++paths;
        const Recomputed again(*scene, *camera, found);
        const double weight = strategy_weight(again.d, found.s, heuristic, scratch);
        double sum = 0;
        for (std::size_t s = 0; s < found.s + found.t; ++s)
            sum += strategy_weight(again.d, s, heuristic, scratch);
        off_sums += !(std::abs(sum - 1) < 1e-12);
        off_weights += !(std::abs(weight - found.weight) < 2e-3);
        const auto differ = [](double a, double b) { return !(std::abs(a - b) <= 0.02 * std::max(a, b)); };
        bool off = differ(again.d.next_event, found.densities.next_event) && found.densities.delta[1] == 0;
        for (std::size_t i = 0; i + 1 < found.s + found.t; ++i)
            off = off || differ(again.d.from_light[i], found.densities.from_light[i]) ||
                  differ(again.d.from_camera[i], found.densities.from_camera[i]);
        // They have any unit.
        for (std::size_t s = 1; s < again.d.media.size(); ++s)
            off = off || differ(again.d.media[s] / again.d.media[0],
                                found.densities.media[s] / found.densities.media[0]);
        off_densities += off;
        for (const std::span<const SubpathVertex>& side : {found.light, found.camera})
            for (const SubpathVertex& v : side) in_media += v.phase != nullptr;
    }
};

// A room that is prepared once, for all lenses and heuristics.
struct PreparedRoom {
    explicit PreparedRoom(const SceneDescription& d)
        : description(d),
          tables(description.scene, description.integrator.environments(),
                 description.integrator.light_sampling, description.integrator.surfaces(), true),
          accelerator(tables.view()) {}

    SceneDescription description;
    SceneTables tables;
    Accelerator accelerator;
};

// The camera and the integrator are those of `description`.
void expect_consistent(const PreparedRoom& room, const SceneDescription& description, int samples,
                       const std::string& what) {
    const SceneTables& tables = room.tables;
    const Camera camera(description.scene.camera, film_width, film_width);
    const BidirectionalIntegrator integrator(description.integrator, camera, 0.125f,
                                             {0, 0, film_width, film_width}, {0.5f, 0.5f},
                                             tables.view().has_media());
    Counts counts{&tables.view(), &camera, description.integrator.heuristic};
    const PathObserver observer{
        [](void* self, const FoundPath& path) { static_cast<Counts*>(self)->count(path); }, &counts};
    RayTracer tracer(room.accelerator);
    BidirectionalMemory memory;
    for (int i = 0; i < samples; ++i) {
        SampleStream stream({.seed = 3}, 0, 0, static_cast<std::uint64_t>(i));
        const Vec2f film = stream.next_2d() * float(film_width), lens = stream.next_2d();
        const CameraSample sample{camera.generate_ray(film, lens),
                                  SampledWavelengths::sample_visible(stream.next_1d())};
        integrator.estimate(tables.view(), tracer, sample, stream, memory, &observer);
    }
    EXPECT_GT(counts.paths, 3 * samples / 2) << what;
    // Every kind of strategy took part: s = 0, 1, more; t = 1, more.
    const int least = samples / (tables.view().has_media() ? 100 : 20);
    for (const int kind : {0 + 2, 4 + 2, 8 + 1, 8 + 2})
        EXPECT_GT(counts.of_strategy[static_cast<std::size_t>(kind)], least) << what << ' ' << kind;
    EXPECT_EQ(counts.off_sums, 0) << what;
    EXPECT_EQ(counts.in_media > counts.paths / 4, tables.view().has_media())
        << what << ' ' << counts.in_media;
    // Rounding: vertices that almost touch, and grazing angles.
    EXPECT_LT(counts.off_densities, counts.paths / 100) << what << " of " << counts.paths;
    EXPECT_LT(counts.off_weights, counts.paths / 500) << what << " of " << counts.paths;
}

TEST(Bidirectional, WeightsAreThoseOfThePathAndSumToOne) {
    const PreparedRoom room(room_of_all(false).description);
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power})
        for (const bool lens : {false, true}) {
            SceneBuilder b = room_of_all(lens);
            b.description.integrator.heuristic = heuristic;
            expect_consistent(room, b.description, 4000, lens ? "lens" : "pinhole");
        }
}

TEST(Bidirectional, WeightsInMediaAreThoseOfThePathAndSumToOne) {
    const PreparedRoom room(foggy_room(false).description);
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power})
        for (const bool lens : {false, true}) {
            SceneBuilder b = foggy_room(lens);
            b.description.integrator.heuristic = heuristic;
            expect_consistent(room, b.description, 2500, lens ? "lens in fog" : "pinhole in fog");
        }
}

// A floor that mirrors by a delta and scatters below its coat: vertices where a path was mirrored are joined to others.
TEST(Bidirectional, WeightsUnderSmoothCoatsAreThoseOfThePathAndSumToOne) {
    SceneBuilder b = room_of_all(false);
    b.scene.materials[0] = CoatedDiffuseMaterial{
        gray(0.6f), CoatingParameters{.roughness = alpha_of(0), .eta = 1.5f, .albedo = gray(0), .g = {0}}};
    expect_consistent(PreparedRoom(b.description), b.description, 3000, "smooth coat");
}

// What a light brings to a camera does not depend on which of the two a path starts from: per area of the surface and
// solid angle, importance scatters as radiance does (Veach 1997, section 5.3).
TEST(Bidirectional, ShadingNormalsScatterBothWaysAlike) {
    SampleStream stream({.seed = 1}, 0, 0, 0);
    SubpathVertex v;
    v.s.ng = {0, 0, 1};
    v.surface.frame = Frame::from_normal(normalize(Vec3f{0.3f, -0.4f, 1}));
    v.surface.bsdf = DiffuseBsdf{SampledSpectrum(0.6f)};
    const std::array<Vec3f, 4> directions{normalize(Vec3f{0, 0, 1}), normalize(Vec3f{0.9f, 0.1f, 0.5f}),
                                          normalize(Vec3f{-0.2f, -0.7f, 1}),
                                          normalize(Vec3f{0.4f, -0.3f, 0.6f})};
    for (const Vec3f to_light : directions)
        for (const Vec3f to_lens : directions) {
            v.wo = v.surface.frame.to_local(to_light);
            const Vec3f wi = v.surface.frame.to_local(to_lens);
            const float importance = v.evaluate(v.wo, wi, TransportMode::importance, stream).f[0] *
                                     v.adjoint_correction(wi) / v.cosine(to_lens);
            const float radiance =
                v.evaluate(wi, v.wo, TransportMode::radiance, stream).f[0] / v.cosine(to_light);
            EXPECT_GT(radiance, 0);
            EXPECT_NEAR(importance / radiance, 1, 1e-5);
        }
}

// Splats count as far from the centres of the outermost pixels as their filter reaches, along both axes. A lamp shines
// on a wall that fills the picture.
TEST(Bidirectional, SplatsReachAsFarAsTheFilter) {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({2, 2, 1})), b.add(DiffuseMaterial{gray(0.5f)}));
    b.scene.lights.push_back(PointLight{white_light(b.scene), white_scale(), {0, 0, 1}});
    b.look({0, 0, 4}, {0, 0, 0}, 28);
    IntegratorSettings& settings = b.description.integrator;
    settings.method = IntegratorKind::light_tracing;
    settings.max_depth = 1;
    const SceneTables tables(b.description.scene, settings.environments(), settings.light_sampling,
                             settings.surfaces(), true);
    const Accelerator accelerator(tables.view());
    const Camera camera(b.description.scene.camera, film_width, film_width);
    const PixelBounds crop{5, 4, 11, 12};
    for (const Vec2f radius : {Vec2f{0.5f, 2}, Vec2f{2, 0.5f}}) {
        const BidirectionalIntegrator integrator(settings, camera, 0.125f, crop, radius, false);
        RayTracer tracer(accelerator);
        BidirectionalMemory memory;
        SplatList splats;
        for (std::uint64_t i = 0; i < 20000; ++i) {
            SampleStream stream({.kind = SamplerKind::independent, .seed = 8}, 0, 0, i);
            CameraSample sample{camera.generate_ray({8, 8}, {}),
                                SampledWavelengths::sample_visible(stream.next_1d())};
            sample.splats = &splats;
            integrator.estimate(tables.view(), tracer, sample, stream, memory, nullptr);
        }
        Point2f low{16, 16}, high{0, 0};
        for (const Splat& splat : splats) {
            low = {std::min(low.x, splat.film.x), std::min(low.y, splat.film.y)};
            high = {std::max(high.x, splat.film.x), std::max(high.y, splat.film.y)};
        }
        const auto expect_just_within = [](float distance) {
            EXPECT_GE(distance, 0);
            EXPECT_LT(distance, 0.25f);
        };
        expect_just_within(low.x - (5.5f - radius.x));
        expect_just_within(low.y - (4.5f - radius.y));
        expect_just_within(10.5f + radius.x - high.x);
        expect_just_within(11.5f + radius.y - high.y);
    }
}

// Three edges at two wavelengths of four: strategy s joins edge s - 1.
TEST(Bidirectional, MediaFactorsInClosedForm) {
    const std::vector<EdgeDensity> edges{
        {{2, 3, 1, 1}, {5, 7, 1, 1}}, {{11, 13, 1, 1}, {17, 19, 1, 1}}, {{23, 29, 1, 1}, {31, 37, 1, 1}}};
    std::vector<double> factors, scratch;
    media_factors(edges, true, factors, scratch);
    EXPECT_EQ(factors, (std::vector<double>{2 * 11 * 23, 5 * 11 * 23, 2 * 17 * 23, 2 * 11 * 31}));
    media_factors(edges, false, factors, scratch);
    EXPECT_EQ(factors, (std::vector<double>{
                           (2 * 11 * 23 + 3 * 13 * 29 + 2) / 4.0, (5 * 11 * 23 + 7 * 13 * 29 + 2) / 4.0,
                           (2 * 17 * 23 + 3 * 19 * 29 + 2) / 4.0, (2 * 11 * 31 + 3 * 13 * 37 + 2) / 4.0}));
}

// In closed form: a path of four vertices, without deltas and with them.
TEST(Bidirectional, WeightsInClosedForm) {
    PathDensities d;
    d.reset(4);
    d.from_light = {2, 3, 5};
    d.from_camera = {7, 11, 13};
    d.next_event = 17;
    d.light_paths = 19;
    std::vector<double> scratch;
    const std::array<double, 4> p{7 * 11 * 13, 17 * 11 * 13, 2 * 3 * 13, 2 * 3 * 5 * 19};
    const double all = p[0] + p[1] + p[2] + p[3];
    double squares = 0;
    for (const double x : p) squares += x * x;
    for (std::size_t s = 0; s < 4; ++s) {
        EXPECT_NEAR(strategy_weight(d, s, Heuristic::balance, scratch), p[s] / all, 1e-14);
        EXPECT_NEAR(strategy_weight(d, s, Heuristic::power, scratch), p[s] * p[s] / squares, 1e-14);
    }
    d.delta[1] = 1; // no strategy joins v_1
    EXPECT_EQ(strategy_weight(d, 1, Heuristic::balance, scratch), 0);
    EXPECT_EQ(strategy_weight(d, 2, Heuristic::balance, scratch), 0);
    EXPECT_NEAR(strategy_weight(d, 0, Heuristic::balance, scratch), p[0] / (p[0] + p[3]), 1e-14);
    d.delta = {0, 0, 1}; // nor v_2
    EXPECT_NEAR(strategy_weight(d, 0, Heuristic::balance, scratch), p[0] / (p[0] + p[1]), 1e-14);
    d.from_camera[0] = 0; // a light that no ray hits
    EXPECT_EQ(strategy_weight(d, 0, Heuristic::balance, scratch), 0);
    EXPECT_EQ(strategy_weight(d, 1, Heuristic::balance, scratch), 1);
}

} // namespace
} // namespace montelux::testing
