// Estimators of the same light through media: they differ in noise alone.
#include "test/render/mixed_scene.h"
#include "test/scene/sparse_grid_testing.h"
#include "test/transport/volume_testing.h"
#include <algorithm>
#include <bit>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/transport/integrator.h"

namespace montelux::testing {
namespace {

// A grid of few, very different densities.
std::vector<float> wild_densities(std::size_t count) {
    TestUniforms uniforms(17);
    std::vector<float> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(3 * std::pow(uniforms.next_float(), 6.0f));
    return values;
}

// Along rays through the cube [-1, 1]^3 with a medium.
template <typename M>
void expect_transmittances_agree(VolumeScene b, const M& m, const std::string& what) {
    b.add_cube(b.add_medium(m));
    b.add_sky();
    b.description.integrator.max_depth = 0;
    const VolumeWorld world(b.description);
    const SceneView& scene = world.tables.view();
    for (const Vec3f d : {normalize(Vec3f(0.1f, -0.2f, 1)), Vec3f(0, 0, 1)}) {
        const Ray ray{{0.15f, 0.25f, -3}, d};
        const SpectralMean delta = radiance_along<VolumePathIntegrator>(world, ray, 30000);
        // Points 1e-4 apart.
        SampledSpectrum depth;
        const auto local = m.at(scene, 0, delta.lambda);
        constexpr double step = 1e-4;
        std::array<double, 4> sum{};
        for (double t = step / 2; t < 6; t += step) {
            const Point3f p = ray.o + d * static_cast<float>(t);
            if (max_component(abs(p)) > 1) continue;
            const MediumPoint c = local.coefficients(p);
            for (int k = 0; k < 4; ++k)
                sum[static_cast<std::size_t>(k)] += step * double((c.sigma_a + c.sigma_s)[k]);
        }
        const auto truth = [&](float lambda) {
            for (int k = 0; k < 4; ++k)
                if (delta.lambda.lambda[k] == lambda) return std::exp(-sum[static_cast<std::size_t>(k)]);
            return 0.0;
        };
        expect_radiance(delta, truth, "delta, " + what, 1e-3);

        SpectralMean ratio;
        ratio.lambda = delta.lambda;
        RayTracer tracer(world.accelerator);
        for (int i = 0; i < 30000; ++i) {
            SampleStream stream({.seed = 5}, 0, 0, static_cast<std::uint64_t>(i));
            const auto through = shadow_transmittance(scene, tracer, ray, no_index, ratio.lambda, stream);
            // By the first wavelength's walk.
            for (int k = 0; k < 4; ++k)
                ratio.moments[static_cast<std::size_t>(k)].add(through ? double(through->t[k]) : 0);
        }
        expect_radiance(ratio, truth, "ratio, " + what, 1e-3);
    }
}

TEST(VolumeAgreement, DeltaTrackingRatioTrackingAndQuadratureOfTransmittance) {
    for (const bool constant : {true, false}) {
        VolumeScene b;
        GridMedium m = b.grid_medium(b.add_grid(
            9, 7, 31, constant ? std::vector<float>(9 * 7 * 31, 0.7f) : wild_densities(9 * 7 * 31)));
        m.sigma_a = b.spectrum(0.2f, 0.9f);
        m.sigma_s = b.spectrum(0.7f, 0.4f);
        expect_transmittances_agree(b, m, constant ? "constant" : "wild");
    }
}

TEST(VolumeAgreement, TransmittanceOfSparseGrids) {
    VolumeScene b;
    SparseGridMedium m;
    const std::vector<float> wild = wild_densities(40 * 20 * 40);
    b.scene.sparse_grids.push_back(sparse_grid({2, 1, 1}, [&](int i, int j, int k) {
        i -= 110; // across the two nodes
        j -= 6;
        if (std::min({i, j, k}) < 0 || i >= 40 || j >= 20 || k >= 40) return 0.0f;
        return (i / 8 + k / 8) % 2 == 0 ? 0.0f : wild[static_cast<std::size_t>((i * 20 + j) * 40 + k)];
    }));
    m.density = 0;
    m.box.p0 = {109, 5, -1};
    m.box.p1 = {150, 26, 40};
    m.box.world_from_medium =
        Transform::scale({2.0 / 41, 2.0 / 21, 2.0 / 41}) * Transform::translate({-129.5, -15.5, -19.5});
    m.sigma_a = b.spectrum(0.2f, 0.9f);
    m.sigma_s = b.spectrum(0.7f, 0.4f);
    m.scale = 2;
    expect_transmittances_agree(b, m, "sparse");
}

// A black body in absorbing gas: its density and its temperature lie on two grids of their own places.
TEST(VolumeAgreement, EmissionOfSparseGrids) {
    VolumeScene b;
    b.scene.sparse_grids.push_back(sparse_grid({1, 1, 1}, [](int i, int j, int k) {
        return std::max({i, j, k}) < 40 ? 0.3f + 0.02f * float(k) : 0;
    }));
    b.scene.sparse_grids.push_back(
        sparse_grid({1, 1, 1}, [](int, int, int k) { return 10 + 3 * static_cast<float>(k); }));
    SparseGridMedium m;
    m.density = 0;
    m.temperature = 1;
    m.box.p0 = {-1, -1, -1};
    m.box.p1 = {40, 40, 40};
    m.box.world_from_medium =
        Transform::scale({2.0 / 41, 2.0 / 41, 2.0 / 41}) * Transform::translate({-19.5, -19.5, -19.5});
    m.temperature_space_from_density = Transform::translate({20, 20, 8}) * Transform::scale({0.5, 0.5, 0.5});
    m.temperature_offset = 20;
    m.temperature_scale = 70;
    m.sigma_a = b.spectrum(0.4f, 1.5f);
    m.sigma_s = 0.0f;
    m.le_scale = 3;
    b.add_cube(b.add_medium(m));
    const SpectralMean mean = volume_radiance(b.description, {{0, 0, -3}, {0, 0, 1}}, 200000);
    const auto truth = [](float lambda) {
        const double sigma = double(line(0.4f, 1.5f)(lambda));
        double depth = 0, radiance = 0;
        constexpr double step = 1e-4;
        for (double z = -1 + step / 2; z < 1; z += step) {
            const double k = 19.5 + 20.5 * z; // of the voxel
            const double fade = std::min({1.0, k + 1, 40 - k}), inner = std::clamp(k, 0.0, 39.0);
            const double a = sigma * (0.3 + 0.02 * inner) * fade;
            const float kelvins = static_cast<float>((10 + 3 * (8 + 0.5 * k) - 20) * 70);
            radiance +=
                std::exp(-depth - a * step / 2) * a * step * 3 * double(BlackbodySpectrum(kelvins)(lambda));
            depth += a * step;
        }
        return radiance;
    };
    expect_radiance(mean, truth, "emission", 1e-3);
}

// A coloured grid with glass, a mirror and lamps in it: inside, outside, visible and not.
VolumeScene lamps_in_fog() {
    VolumeScene b;
    GridMedium m = b.grid_medium(b.add_grid(4, 5, 6, wild_densities(120)));
    m.sigma_a = b.spectrum(0.3f, 0.05f);
    m.sigma_s = b.spectrum(0.5f, 3);
    m.phase = HenyeyGreenstein{0.3f};
    m.le = b.spectrum(0.3f, 0.1f);
    b.add_cube(b.add_medium(m));
    const Index thin = b.add_medium(
        HomogeneousMedium{.sigma_a = b.spectrum(0.02f, 0.2f), .sigma_s = b.spectrum(0.1f, 0.02f)});
    const Index absorbing =
        b.add_medium(HomogeneousMedium{.sigma_a = b.spectrum(0.1f, 2), .sigma_s = 0.0f, .le = 0.2f});
    const Index black = b.add(DiffuseMaterial{gray(0)});
    const auto lamp = [&](const Transform& t, float emission) {
        b.bound(b.add_mesh(square(t), black, emission), no_index, no_index);
    };
    lamp(Transform::translate({0, 0, 2.5}) * Transform::rotate(180, {1, 0, 0}), 2);
    lamp(Transform::translate({0.4, -0.3, -0.4}) * Transform::scale({0.2, 0.2, 0.2}), 20);
    const Transform ball = Transform::translate({-0.4, 0.3, 0.2}) * Transform::scale({0.35, 0.35, 0.35});
    b.bound(b.add_quadric(Sphere{.world_from_object = ball},
                          b.add(DielectricMaterial{b.spectrum(1.6f, 1.4f), alpha_of(0)})),
            absorbing, 0);
    const Transform bubble = Transform::translate({0.4, -0.3, 0.4}) * Transform::scale({0.4, 0.4, 0.4});
    b.bound(b.add_quadric(Sphere{.world_from_object = bubble}, b.interface()), thin, 0);
    b.add_mesh(square(Transform::translate({0, 0, -1.2}) * Transform::scale({3, 3, 1})),
               b.add(DiffuseMaterial{gray(0.6f)}));
    b.add_sky(0.2f);
    b.scene.lights.push_back(DistantLight{SceneSpectrum(0.5f), 1, normalize(Vec3f(0.3f, -1, 0.8f))});
    b.look({0.3, -4, 0.6}, {0, 0, 0}, 35);
    b.description.integrator.max_depth = 20;
    return b;
}

TEST(VolumeAgreement, StrategiesAndHeuristics) {
    VolumeScene b = lamps_in_fog();
    const auto mean = [&](Strategy strategy, Heuristic heuristic, std::uint64_t seed) {
        b.description.integrator.strategy = strategy;
        b.description.integrator.heuristic = heuristic;
        return camera_mean<VolumePathIntegrator>(b.description, 60000, seed);
    };
    const RunningMoments mis = mean(Strategy::mis, Heuristic::power, 1);
    expect_same_mean(mis, mean(Strategy::mis, Heuristic::balance, 2), "balance");
    expect_same_mean(mis, mean(Strategy::bsdf, Heuristic::power, 3), "bsdf");
    expect_same_mean(mis, mean(Strategy::light, Heuristic::power, 4), "light");
    expect_same_mean(mis, mean(Strategy::uniform, Heuristic::power, 5), "uniform");
    // The same numbers: the terms sum to the whole.
    EXPECT_NEAR(mean(Strategy::mis_bsdf, Heuristic::power, 1).mean() +
                    mean(Strategy::mis_light, Heuristic::power, 1).mean(),
                mis.mean(), 1e-3 * mis.mean());
}

// Each wavelength by itself sees the same.
TEST(VolumeAgreement, WavelengthsTogetherAndAlone) {
    const VolumeScene b = lamps_in_fog();
    const VolumeWorld world(b.description);
    const Ray ray{{0.2f, 0.1f, 2}, normalize(Vec3f(-0.3f, 0.1f, -1))};
    const SpectralMean together = radiance_along<VolumePathIntegrator>(world, ray, 160000);
    const VolumePathIntegrator integrator(world.description.integrator, world.camera);
    RayTracer tracer(world.accelerator);
    for (int k = 0; k < 4; ++k) {
        SampledWavelengths lambda = together.lambda;
        lambda.lambda = broadcast(lambda.lambda[k]);
        RunningMoments alone;
        for (int i = 0; i < 40000; ++i) {
            SampleStream stream({.seed = 23}, static_cast<std::uint32_t>(k), 0,
                                static_cast<std::uint64_t>(i));
            const FilmContribution c =
                integrator.estimate(world.tables.view(), tracer, {ray, lambda}, stream);
            alone.add(double(average(c.radiance))); // after dispersion the first carries all
        }
        expect_same_mean(together.moments[static_cast<std::size_t>(k)], alone, std::to_string(k));
    }
}

TEST(VolumeAgreement, WithoutMediaThePathIntegratorAgrees) {
    SceneDescription d = mixed_scene().description;
    d.integrator.environment_compensation = false; // suits every strategy
    const VolumeWorld world(d);
    IntegratorSettings settings = d.integrator;
    for (const Strategy strategy : {Strategy::bsdf, Strategy::light, Strategy::mis}) {
        settings.strategy = strategy;
        expect_same_mean(camera_mean<VolumePathIntegrator>(world, settings, 25000, 1),
                         camera_mean<PathIntegrator>(world, settings, 25000, 2), "room");
    }
}

// Boundaries of nothing, and glass of index 1, are invisible.
TEST(VolumeAgreement, IndexMatchedSpheresVanish) {
    const VolumeWorld room(mixed_scene().description);
    for (const bool glass : {false, true}) {
        SceneBuilder b = mixed_scene();
        b.scene.media.push_back(HomogeneousMedium{.sigma_a = 0.0f, .sigma_s = 0.0f});
        const Transform t = Transform::translate({0, -0.4, 0}) * Transform::scale({0.6, 0.6, 0.6});
        const Index sphere =
            b.add_quadric(Sphere{.world_from_object = t},
                          glass ? b.add(DielectricMaterial{1.0f, alpha_of(0)}) : b.add(InterfaceMaterial{}));
        b.scene.shapes[sphere].media.inside = 0;
        // Glass takes scattering events, and stops shadow rays.
        if (glass) b.description.integrator.max_depth = 40;
        if (glass) b.description.integrator.strategy = Strategy::bsdf;
        expect_same_mean(camera_mean<VolumePathIntegrator>(b.description, 25000, 3),
                         camera_mean<PathIntegrator>(room, b.description.integrator, 25000, 1),
                         glass ? "glass" : "interface");
    }
}

TEST(VolumeIntegrator, SamplesArePureFunctionsAndRecordsDoNotDisturb) {
    const VolumeScene b = lamps_in_fog();
    const VolumeWorld world(b.description);
    const VolumePathIntegrator integrator(world.description.integrator, world.camera);
    RayTracer tracer(world.accelerator);
    std::vector<PathStart<SampleStream>> starts;
    std::vector<FilmContribution> alone;
    int in_media = 0, absorbed = 0;
    for (const SamplerKind kind : samplers)
        for (std::uint64_t i = 0; i < 64; ++i) {
            SampleStream stream({.kind = kind, .seed = 2, .spp = 64}, 3, 4, i);
            const CameraSample camera{world.camera.generate_ray(stream.next_2d() * 16, {}),
                                      SampledWavelengths::sample_visible(stream.next_1d())};
            starts.push_back({camera, stream});
            PathRecord record;
            alone.push_back(integrator.estimate(world.tables.view(), tracer, camera, stream, &record));
            EXPECT_EQ(record.radiance, alone.back().radiance);
            // The contributions of the record sum to the radiance.
            SampledSpectrum sum = record.emission;
            for (const PathVertex& v : record.vertices) {
                for (const FoundLight& light : v.found) sum += light.contribution;
                if (v.direct) sum += v.direct->contribution;
                in_media += v.medium.has_value();
            }
            for (const RayLight& light : record.on_rays) sum += light.light.contribution;
            absorbed += record.end == PathEnd::absorbed;
            for (int k = 0; k < 4; ++k) EXPECT_NEAR(sum[k], record.radiance[k], 1e-4f * (1 + sum[k]));
        }
    EXPECT_GT(in_media, 100);
    EXPECT_GT(absorbed, 10);
    PathBatch batch;
    std::vector<FilmContribution> together(starts.size());
    integrator.estimate(world.tables.view(), tracer, std::span(starts), batch, together);
    using Bits = std::array<std::uint32_t, 4>;
    for (std::size_t i = 0; i < starts.size(); ++i)
        EXPECT_EQ(std::bit_cast<Bits>(together[i].radiance.values),
                  std::bit_cast<Bits>(alone[i].radiance.values));
}

// Not hidden: neither as light that a path hits, nor as a sampled light, nor as emission.
TEST(VolumeIntegrator, InfiniteLightIsReported) {
    const float infinite = std::numeric_limits<float>::infinity();
    for (const int kind : {0, 1, 2}) {
        VolumeScene b;
        b.add_cube(b.add_medium(
            HomogeneousMedium{.sigma_a = 0.1f, .sigma_s = 1.0f, .le = kind == 2 ? infinite : 0.0f}));
        if (kind == 0) b.add_sky(infinite);
        if (kind == 1) b.scene.lights.push_back(DistantLight{SceneSpectrum(infinite), 1, Vec3f(0, 0, 1)});
        b.look({0, 0, -4}, {0, 0, 0}, 10);
        EXPECT_FALSE(std::isfinite(camera_mean<VolumePathIntegrator>(b.description, 100, 1).mean())) << kind;
    }
}

// The renderer takes it for scenes with media or interfaces.
TEST(VolumeIntegrator, IsChosenByTheScene) {
    EXPECT_FALSE(SceneView(mixed_scene().scene).has_media());
    VolumeScene b;
    b.interface();
    EXPECT_TRUE(SceneView(b.scene).has_media());
    EXPECT_TRUE(SceneView(lamps_in_fog().scene).has_media());
    VolumeScene fog;
    fog.add_slab(fog.add_medium(HomogeneousMedium{.sigma_a = 0.7f, .sigma_s = 0.0f}), 1);
    fog.add_uniform_light(1);
    fog.look({0, 0, -4}, {0, 0, 1}, 0.5f);
    const PictureMean mean = picture_mean(render(fog.description));
    EXPECT_NEAR(mean.mean, std::exp(-0.7), 5 * mean.standard_error + 1e-3);
}

} // namespace
} // namespace montelux::testing
