// Pictures of bidirectional path tracing and of light tracing against those of path tracing; their errors; and that the
// picture depends on scene and seed alone.
//
// Means of pictures are compared by Student's test of 16 bidirectional_seeds at 7 standard errors (two-sided: 4e-6 each).
#include "test/render/mixed_scene.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/render_session.h"
#include "montelux/render/sample_record.h"
#include "montelux/render/splat_pass.h"

namespace montelux::testing {
namespace {

constexpr int bidirectional_seeds = 16;

// The means over the picture of renders with different bidirectional_seeds, by channel. Pixels of one render share light paths.
struct SeedMeans {
    std::array<RunningMoments, 3> channel;
    std::vector<Film> films;
};
SeedMeans render_of_seeds(SceneDescription d, IntegratorKind method, std::uint32_t spp,
                          int count = bidirectional_seeds) {
    d.integrator.method = method;
    d.sampler.spp = spp;
    SeedMeans result;
    for (int i = 0; i < count; ++i) {
        d.sampler.seed = static_cast<std::uint64_t>(100 + i);
        result.films.push_back(render(d));
        for (int c = 0; c < 3; ++c)
            result.channel[static_cast<std::size_t>(c)].add(picture_mean(result.films.back(), c).mean);
    }
    return result;
}

struct Agreement {
    double bias = 0;   // largest of the channels, relative
    double error = 0;  // its standard error, relative
    double sigmas = 0; // largest of the channels
    double pooled = 0; // standard deviation of the pixels' differences over their errors
};
Agreement agreement_of(const SeedMeans& a, const SeedMeans& b) {
    Agreement r;
    for (std::size_t c = 0; c < 3; ++c) {
        const double mean = a.channel[c].mean(), difference = std::abs(b.channel[c].mean() - mean),
                     error = std::hypot(a.channel[c].standard_error(), b.channel[c].standard_error());
        r.sigmas = std::max(r.sigmas, difference / error);
        r.bias = std::max(r.bias, difference / mean);
        r.error = std::max(r.error, error / mean);
    }
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < a.films.size(); ++i)
        for (std::size_t p = 0; p < a.films[i].pixels().size(); ++p) {
            const SkewMoments<3>&x = a.films[i].pixels()[p].replicates(),
                  &y = b.films[i].pixels()[p].replicates();
            const double variance = x.variance_of_mean(1) + y.variance_of_mean(1);
            if (!(variance > 0)) continue;
            sum += std::pow(x.mean(1) - y.mean(1), 2) / variance;
            ++count;
        }
    r.pooled = std::sqrt(sum / count);
    return r;
}

void expect_same_light(const SceneBuilder& scene, const std::string& what, std::uint32_t spp = 64,
                       IntegratorKind method = IntegratorKind::bidirectional) {
    const Agreement r = agreement_of(render_of_seeds(scene.description, IntegratorKind::path, spp),
                                     render_of_seeds(scene.description, method, spp));
    EXPECT_LT(r.sigmas, 7) << what << ": " << 100 * r.bias << " %";
    EXPECT_LT(r.bias, 0.01) << what;
    EXPECT_LT(r.error, 0.003) << what; // so that a bias of 1 % would show
    EXPECT_GT(r.pooled, 0.9) << what;
    EXPECT_LT(r.pooled, 1.1) << what;
}

// A floor and a wall, lit by nothing yet.
SceneBuilder lit_corner(const Material& floor = DiffuseMaterial{gray(0.6f)}) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 12;
    b.description.film.crop = {0, 0, 12, 12};
    b.add_mesh(square(Transform::scale({1.5, 1.5, 1})), b.add(floor));
    b.add_mesh(square(Transform::translate({0, 1.2, 0.6}) * Transform::rotate(90, {1, 0, 0})),
               b.add(DiffuseMaterial{gray(0.5f)}));
    b.look({0.2, -4, 2.2}, {0, 0, 0.3}, 40);
    return b;
}
void add_box_lamp(SceneBuilder& b, float emission = 8) {
    b.add_mesh(square(Transform::translate({0.3, -0.2, 1.6}) * Transform::rotate(180, {1, 0, 0}) *
                      Transform::scale({0.3, 0.3, 1})),
               b.add(DiffuseMaterial{gray(0)}), emission);
}

TEST(BidirectionalPictures, RoomOfAllKinds) {
    SceneBuilder b = mixed_scene(1, 12, 12);
    for (const int depth : {1, 2, 3, 4, 6}) {
        b.description.integrator.max_depth = depth;
        expect_same_light(b, "depth " + std::to_string(depth));
    }
}

TEST(BidirectionalPictures, EachDepthAlone) {
    SceneBuilder b = lit_corner();
    add_box_lamp(b);
    b.add_quadric(
        Sphere{.world_from_object = Transform::translate({-0.4, 0, 0.4}) * Transform::scale({0.4, 0.4, 0.4})},
        b.add(ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(3)}, .roughness = alpha_of(0.3f)}));
    for (const int depth : {0, 1, 2, 3}) {
        b.description.integrator.max_depth = depth;
        const SeedMeans path = render_of_seeds(b.description, IntegratorKind::path, 32),
                        joined = render_of_seeds(b.description, IntegratorKind::bidirectional, 32);
        if (depth == 0) {
            EXPECT_EQ(path.channel[1].mean(), joined.channel[1].mean());
            continue;
        }
        EXPECT_LT(agreement_of(path, joined).sigmas, 7) << depth;
        EXPECT_LT(agreement_of(path, joined).bias, 0.01) << depth;
    }
}

TEST(BidirectionalPictures, KindsOfLights) {
    using Add = std::function<void(SceneBuilder&)>;
    const auto light = [](const auto& make) {
        return [make](SceneBuilder& b) { b.scene.lights.push_back(make(white_light(b.scene))); };
    };
    const std::pair<const char*, Add> kinds[] = {
        {"point", light([](SceneSpectrum s) {
             return PointLight{s, 4 * white_scale(), {0.4f, -0.5f, 1.5f}};
         })},
        {"spot", light([](SceneSpectrum s) {
             SpotLight spot;
             spot.spectrum = s;
             spot.scale = 9 * white_scale();
             spot.position = {0.5f, -1, 2};
             spot.axis = normalize(Vec3f(-0.5f, 1.2f, -1.8f));
             spot.cos_falloff_start = 0.95f;
             spot.cos_total_width = 0.85f;
             return spot;
         })},
        {"distant", light([](SceneSpectrum s) {
             return DistantLight{s, 2 * white_scale(), normalize(Vec3f(0.3f, -1, 1))};
         })},
        {"sky", [](SceneBuilder& b) { b.add_uniform_light(0.7f); }},
        {"lamp", [](SceneBuilder& b) { add_box_lamp(b); }},
        {"sphere",
         [](SceneBuilder& b) {
             b.add_quadric(Sphere{.radius = 0.2f,
                                  .z_min = -0.2f,
                                  .z_max = 0.2f,
                                  .world_from_object = Transform::translate({0.2, -0.3, 0.9})},
                           b.add(DiffuseMaterial{gray(0)}), 5);
         }},
        {"map", [](SceneBuilder& b) {
             Image map(8, 8, {"R", "G", "B"});
             for (int i = 0; i < 64; ++i)
                 for (int c = 0; c < 3; ++c) map.set(i % 8, i / 8, c, i == 20 ? 6.0f : 0.3f);
             b.scene.environments.push_back(map);
             b.scene.lights.push_back(
                 ImageInfiniteLight{.environment = 0, .scale = white_scale(), .world_from_light = {}});
         }}};
    for (const auto& [name, add] : kinds) {
        SceneBuilder b = lit_corner();
        add(b);
        expect_same_light(b, name, 48);
    }
}

// Vertex normals: what light brings must be corrected for them.
TEST(BidirectionalPictures, ShadingNormals) {
    SceneBuilder b = lit_corner();
    TriangleMesh bent = square(Transform::translate({-0.2, -0.2, 0.3}) * Transform::rotate(25, {0, 1, 0}) *
                               Transform::scale({0.6, 0.6, 1}));
    for (const Vec3f n :
         {Vec3f{-0.6f, -0.2f, 1}, Vec3f{0.8f, 0, 1}, Vec3f{0.6f, 0.6f, 1}, Vec3f{-0.3f, 0.7f, 1}})
        bent.normals.push_back(normalize(n));
    b.add_mesh(bent, b.add(DiffuseMaterial{gray(0.8f)}));
    add_box_lamp(b);
    expect_same_light(b, "bidirectional", 64);
    expect_same_light(b, "light tracing", 256, IntegratorKind::light_tracing);
}

TEST(BidirectionalPictures, LightTracingOfRoughSurfaces) {
    SceneBuilder b = lit_corner(CoatedDiffuseMaterial{
        gray(0.6f),
        CoatingParameters{.roughness = alpha_of(0.4f), .eta = 1.5f, .albedo = gray(0), .g = {0}}});
    add_box_lamp(b);
    expect_same_light(b, "lamp", 256, IntegratorKind::light_tracing);
    b.scene.lights.push_back(PointLight{white_light(b.scene), 4 * white_scale(), {0.4f, -0.5f, 1.5f}});
    b.description.film.filter = GaussianFilter{};
    b.description.film.crop = {2, 1, 11, 12};
    expect_same_light(b, "crop and filter", 256, IntegratorKind::light_tracing);
}

// A lens, an orthographic camera, filters wider than a pixel, and crops.
TEST(BidirectionalPictures, CamerasAndFilters) {
    SceneBuilder b = lit_corner();
    add_box_lamp(b);
    b.description.film.crop = {1, 3, 12, 10};
    b.description.film.filter = GaussianFilter{};
    b.scene.camera.model = PerspectiveCamera{.fov = 40, .lens_radius = 0.3f, .focal_distance = 3};
    expect_same_light(b, "lens", 48);
    expect_same_light(b, "lens, light alone", 256, IntegratorKind::light_tracing);
    b.description.film.filter = MitchellFilter{};
    b.scene.camera.model = OrthographicCamera{.screen_window = ScreenWindow{-1.2f, 1.2f, -1, 1.4f}};
    expect_same_light(b, "orthographic", 48);
    expect_same_light(b, "orthographic, light alone", 256, IntegratorKind::light_tracing);
}

// Refraction, of smooth and of rough glass, with dispersion: importance is not scaled as radiance is.
TEST(BidirectionalPictures, GlassWithDispersion) {
    const Spectrum flint(PiecewiseLinear::from_pairs(std::array{360.0f, 1.8f, 830.0f, 1.5f}));
    for (const float alpha : {0.0f, 0.3f}) {
        SceneBuilder b = lit_corner();
        add_box_lamp(b);
        const Transform t = Transform::translate({0, -0.2, 0.6}) * Transform::scale({0.5, 0.5, 0.5});
        b.add_quadric(Sphere{.world_from_object = t},
                      b.add(DielectricMaterial{add_spectrum(b.scene, flint), alpha_of(alpha)}));
        expect_same_light(b, "alpha " + std::to_string(alpha), 128);
    }
}

// Inside a closed surface of albedo rho that emits E, radiance is E (1 + rho + rho^2 + ...).
TEST(BidirectionalPictures, Furnace) {
    SceneBuilder b;
    b.add_quadric(Sphere{}, b.add(DiffuseMaterial{gray(0.5f)}), 1, true);
    b.look({0.2, 0.1, -0.3}, {1, 0, 0}, 60);
    for (const int depth : {0, 1, 2, 200}) {
        b.description.integrator.max_depth = depth;
        const double truth = 2 - std::pow(0.5, depth);
        for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
            b.description.integrator.heuristic = heuristic;
            const SeedMeans m = render_of_seeds(b.description, IntegratorKind::bidirectional, 16);
            EXPECT_NEAR(m.channel[1].mean(), truth, 7 * m.channel[1].standard_error() + 2e-4 * truth)
                << depth;
        }
    }
}

// The share of bidirectional_seeds in which the truth lies within one and two errors of a pixel, by Student's law of the passes.
TEST(BidirectionalPictures, ErrorsOfPixelsAreCalibrated) {
    SceneBuilder b = lit_corner();
    add_box_lamp(b);
    b.description.film.crop = {2, 2, 10, 10};
    const SeedMeans truth = render_of_seeds(b.description, IntegratorKind::path, 1024);
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        b.description.sampler.replicates = kind == SamplerKind::sobol ? 32 : 0;
        const SeedMeans renders = render_of_seeds(b.description, IntegratorKind::bidirectional, 64, 40);
        double within_one = 0, within_two = 0, count = 0;
        for (std::size_t p = 0; p < renders.films[0].pixels().size(); ++p) {
            double expected = 0, variance = 0;
            for (const Film& film : truth.films) {
                expected += film.pixels()[p].replicates().mean(1) / bidirectional_seeds;
                variance += film.pixels()[p].replicates().variance_of_mean(1) /
                            (bidirectional_seeds * bidirectional_seeds);
            }
            for (const Film& film : renders.films) {
                const SkewMoments<3>& r = film.pixels()[p].replicates();
                EXPECT_EQ(r.count(), kind == SamplerKind::sobol ? 32u : 64u);
                const double t = std::abs(r.mean(1) - expected) / std::sqrt(r.variance_of_mean(1) + variance);
                within_one += t < 1;
                within_two += t < 2;
                ++count;
            }
        }
        // Of Student's law with 31 and 63 degrees of freedom: 67.5 and 67.9 %, 94.6 and 95.0 %. 2560 scores, of which
        // those of one render are dependent.
        EXPECT_NEAR(within_one / count, 0.677, 0.035) << int(kind);
        EXPECT_NEAR(within_two / count, 0.948, 0.02) << int(kind);
    }
}

int differing(const Film& a, const Film& b) {
    int n = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) n += !same_pixel(a.pixels()[i], b.pixels()[i]);
    return n;
}

SceneBuilder bidirectional_room(int width, int height) {
    SceneBuilder b = mixed_scene(1, width, height);
    b.description.integrator.method = IntegratorKind::bidirectional;
    b.description.film.filter = GaussianFilter{};
    return b;
}

TEST(BidirectionalPictures, AnyNumberOfThreadsGivesTheSameBits) {
    SceneBuilder b = bidirectional_room(40, 24);
    b.description.sampler.spp = under_sanitizers ? 2 : 6;
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        b.description.sampler.replicates = kind == SamplerKind::sobol ? 2 : 0;
        std::vector<Film> films;
        for (const int threads : {1, 2, 7})
            with_threads(threads, [&] { films.push_back(render(b.description)); });
        for (std::size_t i = 1; i < films.size(); ++i)
            EXPECT_EQ(differing(films[0], films[i]), 0) << int(kind);
        b.description.sampler.seed = 2;
        EXPECT_GT(differing(films[0], render(b.description)), 900);
        b.description.sampler.seed = 0;
    }
}

// Interrupted within passes, saved, and resumed.
TEST(BidirectionalPictures, ResumedRendersHaveTheSameBits) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "render.state";
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        SceneBuilder b = bidirectional_room(40, 24);
        b.description.sampler.kind = kind;
        b.description.sampler.spp = under_sanitizers ? 6 : 28;
        RenderState whole(b.description);
        Renderer(b.description).render(whole);
        int stops = 0, within_passes = 0;
        for (bool ended = false; !ended; ++stops) {
            RenderState state(b.description);
            SceneDescription description = b.description;
            if (stops > 0) {
                RestoredRender restored = load_checkpoint(path, description, {});
                description.sampler.replicate_points = restored.replicate_points;
                state = std::move(restored.state);
                within_passes += open_samples(state.film) > 0;
            }
            const Renderer renderer(description);
            CancelFlag cancel;
            const std::uint64_t begin = state.report.samples, more = 1 + hash_key(7, stops) % 6000;
            RenderControl control;
            control.cancel = &cancel;
            control.checkpoint_seconds = 0.002;
            control.checkpoint = [&](const RenderState& s) {
                save_checkpoint(path, renderer, s);
                if (s.report.samples >= begin + more) cancel.request();
            };
            renderer.render(state, control);
            ended = !state.report.cancelled();
            if (ended) {
                EXPECT_EQ(differing(state.film, whole.film), 0) << int(kind);
            }
            ASSERT_LT(stops, 1000);
        }
        EXPECT_GT(stops, 2) << int(kind);
        EXPECT_GT(within_passes, 0) << int(kind);
    }
}

// A picture of an interrupted render contains whole passes only; one that was kept open goes on to the same bits.
TEST(BidirectionalPictures, OpenPassesAreLeftOut) {
    SceneBuilder b = bidirectional_room(40, 24);
    b.description.sampler = {.kind = SamplerKind::sobol, .seed = 5, .spp = 32};
    b.description.sampler.replicates = 4;
    RenderState whole(b.description);
    Renderer(b.description).render(whole);
    const auto description = std::make_shared<const SceneDescription>(b.description);
    RenderSession session(description, {});
    CancelFlag cancel;
    RenderCompany company;
    company.keep_open = true;
    company.cancel = &cancel;
    company.progress = [&](const RenderProgress& p) {
        if (p.samples_done >= 12 * 960) cancel.request();
    };
    session.render(company);
    ASSERT_TRUE(session.report().cancelled());
    const RenderSnapshot part = session.picture();
    const std::optional<int> replicates = part.image->find_channel("replicates");
    ASSERT_TRUE(replicates);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 40; ++x)
            EXPECT_EQ(part.image->value(x, y, *replicates), part.image->value(0, 0, *replicates));
    session.render({});
    const RenderSnapshot finished = session.finish();
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 40; ++x)
            ASSERT_EQ(finished.image->value(x, y, 1),
                      static_cast<float>(whole.film.pixel(x, y).replicates().mean(1)));
}

std::string refusal_of(const SceneDescription& d, const RenderTarget& target = {}) {
    try {
        Renderer renderer(d, target);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(BidirectionalPictures, RefusesWhatItCannotDo) {
    const SceneBuilder room = bidirectional_room(8, 8);
    EXPECT_EQ(refusal_of(room.description), "");
    const auto expect_refused = [&](const std::function<void(SceneDescription&)>& change, const char* word) {
        SceneDescription d = room.description;
        change(d);
        EXPECT_NE(refusal_of(d).find(word), std::string::npos) << word << ": " << refusal_of(d);
        d.integrator.method = IntegratorKind::path;
        EXPECT_EQ(refusal_of(d), "") << word;
    };
    expect_refused(
        [](auto& d) { d.scene.media.push_back(HomogeneousMedium{.sigma_a = 0.1f, .sigma_s = 0.0f}); },
        "media");
    expect_refused([](auto& d) { d.scene.camera.model = SphericalCamera{}; }, "spherical");
    expect_refused([](auto& d) { d.integrator.strategy = Strategy::light; }, "strategies");
    expect_refused([](auto& d) { d.integrator.regularize = true; }, "regularization");
    expect_refused([](auto& d) { d.integrator.shading_terminator = ShadingTerminator::soft; }, "terminator");
    expect_refused([](auto& d) { d.film.layers.set.add(Layer::direct); }, "parts of the light");
    expect_refused([](auto& d) { d.film.spectral = SpectralSettings{}; }, "spectral");
    EXPECT_NE(refusal_of(room.description, {.adaptive = true}).find("--adaptive"), std::string::npos);
    EXPECT_THROW(Renderer(room.description).replay(1, 1, 0), Error);
}

} // namespace
} // namespace montelux::testing
