// Metropolis light transport: the picture of the path tracer, with errors that hold.
#include "test/render/mixed_scene.h"
#include "test/sanitized.h"
#include "test/significance.h"
#include "test/temporary_folder.h"
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "montelux/film/pixel_warnings.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/z_test.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/render_session.h"
#include "montelux/render/render_warnings.h"
#include "montelux/render/sample_record.h"

namespace montelux::testing {
namespace {

SceneDescription metropolis(SceneDescription d, std::uint32_t spp, std::uint64_t seed = 1) {
    d.integrator.method = IntegratorKind::metropolis;
    d.sampler.spp = spp;
    d.sampler.seed = seed;
    return d;
}
Film path_traced(SceneDescription d, std::uint32_t spp,
                 std::shared_ptr<const PreparedScene> prepared = nullptr) {
    d.sampler.kind = SamplerKind::independent;
    d.sampler.spp = spp;
    d.sampler.seed = 77;
    return render(d, std::move(prepared));
}
RenderState rendered(const SceneDescription& d, const RenderTarget& target = {},
                     std::shared_ptr<const PreparedScene> prepared = nullptr) {
    RenderState state(d);
    Renderer(d, target, 0, std::move(prepared)).render(state);
    return state;
}

double luminance(const Pixel& p) {
    double l = 0;
    for (int c = 0; c < 3; ++c) l += luminance_weight[c] * p.replicates().mean(c);
    return l;
}

void expect_same_bits(const Film& a, const Film& b) {
    int differing = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        differing += !same_pixel(a.pixels()[i], b.pixels()[i]);
    EXPECT_EQ(differing, 0);
}

// A mirror ball and a glass ball on a floor below a small lamp, seen through a lens.
SceneBuilder caustics() {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 16;
    b.description.film.crop = {0, 0, 16, 16};
    b.description.film.filter = GaussianFilter{};
    b.add_mesh(square(Transform::scale({3, 3, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    const auto ball = [&](Vec3d at, double radius, const Material& m) {
        b.add_quadric(Sphere{.world_from_object =
                                 Transform::translate(at) * Transform::scale({radius, radius, radius})},
                      b.add(m));
    };
    ball({-0.7, 0, 0.6}, 0.6, ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(3)}});
    ball({0.7, 0.1, 0.6}, 0.55, DielectricMaterial{1.5f, alpha_of(0)});
    b.add_mesh(square(Transform::translate({0.3, 0.8, 3}) * Transform::rotate(180, {1, 0, 0}) *
                      Transform::scale({0.6, 0.6, 1})),
               b.add(DiffuseMaterial{gray(0)}), 6);
    b.look({0, -4, 2.5}, {0, 0, 0.3}, 40);
    auto& camera = std::get<PerspectiveCamera>(b.scene.camera.model);
    camera.lens_radius = 0.05f;
    camera.focal_distance = 4.5f;
    return b;
}

// Differences of pixels over their errors: their mean square, and the relative difference of the pictures' means.
// Pixels whose errors are doubtful are left out of the scores.
struct Agreement {
    double mean_square = 0, bias = 0;
    int pixels = 0;
};
Agreement agreement(const Film& a, const Film& b) {
    Agreement r;
    const std::vector<PixelWarning> doubts = pixel_warnings(a), doubts_b = pixel_warnings(b);
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const Pixel &p = a.pixels()[i], &q = b.pixels()[i];
        const double d = luminance(p) - luminance(q);
        const double v = std::pow(luminance_error(p), 2) + std::pow(luminance_error(q), 2);
        difference += d;
        sum += luminance(q);
        if (marks_unreliable_error(doubts[i]) || marks_unreliable_error(doubts_b[i]) || !(v > 0)) continue;
        r.mean_square += d * d / v;
        ++r.pixels;
    }
    r.mean_square /= r.pixels;
    r.bias = difference / sum;
    return r;
}

// Of several seeds against one picture of far smaller errors. With 32 groups the expected square of a score is
// 31/29 times the share that the chains have in the variance.
void expect_agreement(const char* name, const SceneDescription& d, std::uint32_t spp, std::uint32_t path_spp,
                      int seeds) {
    const auto prepared = prepared_scene(d);
    const Film paths = path_traced(d, path_spp, prepared);
    double square = 0;
    RunningMoments bias;
    int pixels = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const Film chains = render(metropolis(d, spp, static_cast<std::uint64_t>(seed)), prepared);
        const Agreement a = agreement(chains, paths);
        square += a.mean_square / seeds;
        bias.add(a.bias);
        pixels += a.pixels;
    }
    // Pixels of a group are correlated: the error of the mean comes from the seeds, which share one picture of paths.
    const PictureMean mean = picture_mean(paths);
    const double error = std::hypot(bias.standard_error(), mean.standard_error / mean.mean);
    std::printf("%-12s root mean square score %.3f over %d pixels, bias %.3f %% +- %.3f %%\n", name,
                std::sqrt(square), pixels, 100 * bias.mean(), 100 * error);
    EXPECT_GT(pixels, seeds * static_cast<int>(paths.pixels().size()) / 2) << name;
    EXPECT_GT(std::sqrt(square), 0.9) << name;
    EXPECT_LT(std::sqrt(square), 1.1) << name;
    EXPECT_LT(std::abs(bias.mean()), 0.005 + 5 * error) << name;
    EXPECT_LT(error, 0.01) << name;
}

TEST(MetropolisRender, AgreesWithPathTracing) {
    SceneBuilder mixed = mixed_scene(1, 12, 12);
    expect_agreement("mixed", mixed.description, 256, 2048, 8);
    mixed.description.film.filter = MitchellFilter{};
    mixed.description.film.crop = {1, 1, 11, 11};
    expect_agreement("crop", mixed.description, 256, 2048, 8);
}

// Exposed, balanced, limited and with a background.
TEST(MetropolisRender, ExposesAsPathTracing) {
    SceneBuilder b = mixed_scene(1, 12, 12);
    b.look({0, -6, 0}, {0, 0, 0}, 40); // sees past the box
    b.description.film.iso = 250;
    b.description.film.white_balance = 5000;
    b.description.film.sensor = "canon_eos_5d_mkii";
    b.description.film.max_component_value = 2;
    b.description.integrator.background = Vec3f{0.3f, 0.5f, 1.2f};
    expect_agreement("exposure", b.description, 256, 2048, 8);
}

TEST(MetropolisRender, AnyNumberOfThreads) {
    const SceneDescription d = metropolis(caustics().description, under_sanitizers ? 8 : 64);
    std::vector<Film> films;
    for (const int threads : {1, 2, 7, 20}) with_threads(threads, [&] { films.push_back(render(d)); });
    for (std::size_t i = 1; i < films.size(); ++i) expect_same_bits(films[0], films[i]);
    EXPECT_EQ(films[0].pixels()[0].replicates().count(), under_sanitizers ? 8u : 32u);
    EXPECT_EQ(films[0].pixels()[0].samples(), d.sampler.spp);
    Film other = render(metropolis(d, d.sampler.spp, 2));
    EXPECT_NE(luminance(other.pixels()[200]), luminance(films[0].pixels()[200]));
}

// Features are those of the first surfaces.
TEST(MetropolisRender, FeaturesAreThoseOfPathTracing) {
    const SceneDescription d = mixed_scene(1, 12, 12).description;
    const auto prepared = prepared_scene(d);
    const Film paths = path_traced(d, 1024, prepared), chains = render(metropolis(d, 64), prepared);
    double albedo = 0, normal = 0, depth = 0, mean_depth = 0;
    const double n = static_cast<double>(paths.pixels().size());
    for (std::size_t i = 0; i < paths.pixels().size(); ++i) {
        const Pixel &p = chains.pixels()[i], &q = paths.pixels()[i];
        albedo += double(length(p.albedo() - q.albedo())) / n;
        normal += double(length(p.normal() - q.normal())) / n;
        depth += double(std::abs(p.depth() - q.depth())) / n;
        mean_depth += double(q.depth()) / n;
    }
    EXPECT_LT(albedo, 0.06); // of sampled wavelengths
    EXPECT_LT(normal, 0.05);
    EXPECT_LT(depth, 0.02 * mean_depth);
}

// A given probability is used unchanged, even outside the automatic range.
TEST(MetropolisRender, LargeStepsAreAsFrequentAsAskedFor) {
    SceneDescription d = metropolis(mixed_scene(1, 8, 8).description, 64);
    const auto prepared = prepared_scene(d);
    for (const float share : {0.02f, 0.8f}) {
        d.integrator.large_step_probability = share;
        const ChainStatistics chains = rendered(d, {}, prepared).report.chains;
        EXPECT_EQ(chains.large_step_probability, share);
        const auto large = static_cast<double>(chains.large_steps);
        const double steps = large + static_cast<double>(chains.small_steps);
        // Binomial: six standard errors, 2e-9.
        EXPECT_NEAR(large / steps, double(share), 6 * std::sqrt(double(share) * (1 - double(share)) / steps));
    }
    d.integrator.large_step_probability = 0;
    const double automatic = double(rendered(d, {}, prepared).report.chains.large_step_probability);
    EXPECT_GT(automatic, 0.09);
    EXPECT_LT(automatic, 0.51);
}

// A furnace of known brightness, by chains of few states. The clamp, which no sample reaches, makes chains carry all
// light.
TEST(MetropolisRender, ShortChainsLoseNoLight) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 1;
    b.description.film.crop = {0, 0, 1, 1};
    b.description.film.max_component_value = 1e6f;
    b.description.integrator.max_depth = 2;
    b.add_quadric(Sphere{}, b.add(DiffuseMaterial{gray(0.5f)}), 1, true);
    b.look({0.2, 0.1, -0.3}, {1, 0, 0}, 60);
    SceneDescription d = metropolis(b.description, 2048);
    d.sampler.replicate_points = 4;
    const RenderState state = rendered(d);
    EXPECT_EQ(state.report.chains.states, 3u);
    EXPECT_EQ(state.report.chains.groups, 512u);
    // Student's test of 512 groups at 7 standard errors: 1e-11.
    const PictureMean mean = picture_mean(state.film);
    EXPECT_LT(mean.standard_error, 0.05);
    EXPECT_NEAR(mean.mean, 1.75, 7 * mean.standard_error);
}

// Cancelled at many moments and resumed from the file.
TEST(MetropolisRender, InterruptedRendersEndWithTheSameBits) {
    TemporaryFolder folder;
    const std::filesystem::path path = folder / "render.state";
    const SceneDescription d = metropolis(mixed_scene(1, 16, 12).description, under_sanitizers ? 16 : 128);
    const auto prepared = prepared_scene(d);
    const RenderState whole = rendered(d, {}, prepared);
    int stops = 0;
    for (bool ended = false; !ended;) {
        RenderState state(d);
        SceneDescription description = d;
        if (stops > 0) {
            RestoredRender restored = load_checkpoint(path, description, {});
            description.sampler.replicate_points = restored.replicate_points;
            state = std::move(restored.state);
        }
        const Renderer renderer(description, {}, 0, prepared);
        CancelFlag cancel;
        int reports = 0;
        RenderControl control;
        control.cancel = &cancel;
        control.checkpoint_seconds = 0.002;
        const std::uint64_t begin = state.report.samples;
        control.checkpoint = [&](const RenderState& s) {
            save_checkpoint(path, renderer, s);
            if (s.report.samples > begin && ++reports > stops % 3) cancel.request();
        };
        renderer.render(state, control);
        ended = !state.report.cancelled();
        if (ended) {
            expect_same_bits(state.film, whole.film);
            EXPECT_EQ(state.report.chains.agreement.worst_r_hat(),
                      whole.report.chains.agreement.worst_r_hat());
            EXPECT_EQ(state.report.chains.small_steps, whole.report.chains.small_steps);
        }
        ASSERT_LT(++stops, 1000);
    }
    EXPECT_GT(stops, 3);
}

// A time limit leaves at least two groups, and whole ones.
TEST(MetropolisRender, TimeLimitLeavesErrors) {
    const SceneDescription d = metropolis(mixed_scene(1, 32, 32).description, 1 << 20);
    const RenderState state = rendered(d, {.time = 0.3});
    EXPECT_EQ(state.report.stop, RenderStop::time);
    const std::uint64_t groups = state.film.pixels()[0].replicates().count();
    EXPECT_GE(groups, 2u);
    for (const Pixel& p : state.film.pixels()) {
        EXPECT_EQ(p.replicates().count(), groups);
        EXPECT_EQ(p.samples(), 2 * groups);
    }
    EXPECT_TRUE(std::isfinite(state.film.error().relative));
}

TEST(MetropolisRender, TargetErrorIsReached) {
    const SceneDescription d = metropolis(mixed_scene(1, 16, 16).description, 1 << 20);
    const RenderState state = rendered(d, {.error = 0.1});
    EXPECT_EQ(state.report.stop, RenderStop::error);
    EXPECT_LE(state.film.error().relative, 0.1);
    EXPECT_GE(state.film.pixels()[0].replicates().count(), 8u);
}

// Slices are groups of the whole render.
TEST(MetropolisRender, SlicesShareTheGroups) {
    const SceneDescription d = metropolis(mixed_scene(1, 8, 8).description, 64);
    const auto prepared = prepared_scene(d);
    const Film whole = render(d, prepared);
    double sum = 0;
    for (std::uint32_t k = 0; k < 2; ++k) {
        const RenderState part = rendered(d, {.slice = {k, 2}}, prepared);
        EXPECT_EQ(part.film.pixels()[0].replicates().count(), 16u);
        sum += luminance(part.film.pixels()[20]) / 2;
    }
    EXPECT_NEAR(sum, luminance(whole.pixels()[20]), 1e-12);
}

// A scene without light: black with errors of 0, and a sentence.
TEST(MetropolisRender, NoLightGivesAWarning) {
    SceneBuilder b;
    b.add_mesh(square(Transform()), b.add(DiffuseMaterial{gray(0.5f)}));
    b.look({0, 0, 3}, {0, 0, 0}, 30);
    const RenderState state = rendered(metropolis(b.description, 32));
    double albedo = 0;
    for (const Pixel& p : state.film.pixels()) {
        EXPECT_EQ(luminance(p), 0);
        EXPECT_EQ(luminance_error(p), 0);
        EXPECT_EQ(p.replicates().count(), 32u);
        albedo += double(p.albedo().y) / static_cast<double>(state.film.pixels().size());
    }
    EXPECT_NEAR(albedo, 0.5, 0.02);
    EXPECT_NE(chain_warning(state.report.chains).find("no chain found light"), std::string::npos);
    EXPECT_EQ(chain_warning(ChainStatistics{}), "");
}

// Light that no starting point of some groups finds: a small lamp between a floor and a ceiling, found by hitting it.
TEST(MetropolisRender, DarkGroupsAreUnbiasedAndGiveAWarning) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 4;
    b.description.film.crop = {0, 0, 4, 4};
    const Index white = b.add(DiffuseMaterial{gray(0.8f)});
    b.add_mesh(square(Transform::scale({3, 3, 1})), white);
    b.add_mesh(square(Transform::translate({0, 0, 1}) * Transform::scale({3, 3, 1})), white);
    b.add_mesh(square(Transform::translate({0.5, 0, 0.9}) * Transform::rotate(180, {1, 0, 0}) *
                      Transform::scale({0.1, 0.1, 1})),
               b.add(DiffuseMaterial{gray(0)}), 20);
    b.look({-2.5, 0, 0.5}, {0, 0, 0.3}, 40);
    const Film paths = path_traced(b.description, 16384);
    b.description.integrator.strategy = Strategy::bsdf;
    RunningMoments means;
    constexpr std::uint64_t seeds = 60;
    std::uint64_t dark = 0;
    double exact = 0;
    for (const Pixel& p : paths.pixels()) exact += luminance(p);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const RenderState state = rendered(metropolis(b.description, 64 * 32, seed));
        double sum = 0;
        for (const Pixel& p : state.film.pixels()) sum += luminance(p);
        means.add(sum);
        dark += state.report.chains.dark_groups;
        const ChainStatistics& chains = state.report.chains;
        if (chains.dark_groups > 0) {
            const char* sentence =
                chains.dark_groups == chains.groups ? "no chain found light" : "found no light to start from";
            EXPECT_NE(chain_warning(chains).find(sentence), std::string::npos);
        }
    }
    EXPECT_GT(dark, seeds * 8);
    EXPECT_LT(dark, seeds * 31);
    const double error = std::hypot(means.standard_error(), picture_mean(paths).standard_error * 16);
    std::printf("%llu dark groups, mean %.4f +- %.4f, exactly %.4f\n", static_cast<unsigned long long>(dark),
                means.mean(), error, exact);
    EXPECT_LT(std::abs(means.mean() - exact), 5 * error);
    EXPECT_LT(error, 0.05 * exact);
}

TEST(MetropolisRender, WhatItCannotDoIsRefused) {
    const SceneDescription good = metropolis(mixed_scene(1, 8, 8).description, 32);
    const auto refused = [](const SceneDescription& d, const RenderTarget& target = {}) {
        try {
            Renderer renderer(d, target);
        } catch (const Error& e) {
            return std::string(e.what()).find("metropolis") == 0;
        }
        return false;
    };
    EXPECT_FALSE(refused(good));
    SceneDescription d = good;
    d.integrator.occlusion.emplace();
    EXPECT_TRUE(refused(d));
    d = good;
    d.film.spectral.emplace();
    EXPECT_TRUE(refused(d));
    d = good;
    d.film.layers.set.add(Layer::direct);
    EXPECT_TRUE(refused(d));
    d = good;
    d.integrator.large_step_probability = 2;
    EXPECT_TRUE(refused(d));
    EXPECT_TRUE(refused(good, {.adaptive = true}));
    EXPECT_THROW(Renderer(good).replay(0, 0, 0), Error);
}

// Over many seeds the truth lies within one and two errors as often as Student's law says: 68.3 % and 95.4 % in the
// limit of many groups, 67.5 % and 94.6 % for 32 (31 degrees of freedom). Counts over pixels are correlated, so the
// limits are those of seeds.
TEST(MetropolisRender, ErrorsAreCalibrated) {
    const SceneDescription d = mixed_scene(1, 8, 8).description;
    constexpr std::uint32_t spp = 128;
    const Film paths = path_traced(d, 16384);
    RunningMoments within_1, within_2;
    std::vector<RunningMoments> pixels(paths.pixels().size());
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const Film film = render(metropolis(d, spp, seed));
        const std::vector<PixelWarning> doubts = pixel_warnings(film);
        double one = 0, two = 0, count = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const Pixel &p = film.pixels()[i], &q = paths.pixels()[i];
            pixels[i].add(luminance(p));
            if (marks_unreliable_error(doubts[i]) || !(luminance_error(q) > 0)) continue;
            const double error = std::hypot(luminance_error(p), luminance_error(q));
            const double z = std::abs(luminance(p) - luminance(q)) / error;
            one += z < 1;
            two += z < 2;
            ++count;
        }
        within_1.add(one / count);
        within_2.add(two / count);
    }
    std::printf("within 1 error %.3f +- %.3f, within 2 %.3f +- %.3f\n", within_1.mean(),
                within_1.standard_error(), within_2.mean(), within_2.standard_error());
    EXPECT_NEAR(within_1.mean(), 0.675, 0.02 + 4 * within_1.standard_error());
    EXPECT_NEAR(within_2.mean(), 0.946, 0.01 + 4 * within_2.standard_error());
    // Unbiased: the mean over seeds is that of path tracing, in the whole picture and pixel by pixel.
    double square = 0, lit = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!(luminance_error(paths.pixels()[i]) > 0)) continue;
        const double e = std::hypot(pixels[i].standard_error(), luminance_error(paths.pixels()[i]));
        const double z = (pixels[i].mean() - luminance(paths.pixels()[i])) / e;
        square += z * z;
        ++lit;
    }
    // 39 degrees of freedom: 39/37 = 1.05 expected.
    std::printf("mean square of the pixels' scores over seeds %.3f\n", square / lit);
    EXPECT_LT(square / lit, 1.6);
}

} // namespace
} // namespace montelux::testing
