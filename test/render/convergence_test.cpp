// Whether pixel errors are calibrated and fall at the right rate, and all strategies agree. z-tests of sums
// are at 5.5 standard errors (4e-8), the binomial tests of calibration at 1e-7.
#include "test/render/mixed_scene.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <memory>

#include "montelux/mc/math/special.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux::testing {
namespace {

constexpr SamplerKind samplers[] = {SamplerKind::independent, SamplerKind::stratified,
                                    SamplerKind::halton,      SamplerKind::hammersley,
                                    SamplerKind::sobol,       SamplerKind::sobol_blue_noise};

// The normal deviate that is as unlikely as this deviation of the mean of a few replicates.
double normal_score(const SkewMoments<3>& replicates, double truth) {
    double t = (replicates.mean(1) - truth) / replicates.standard_error(1);
    double p = student_t_cdf(-std::abs(t), static_cast<double>(replicates.count() - 1));
    return std::copysign(std::min(9.0, -normal_quantile(std::max(p, 1e-18))), t);
}

// A floor of albedo 0.6 under a uniform sky shows 0.6 of it, however its light is found.
SceneBuilder floor_under_sky() {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({100, 100, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    b.add_uniform_light(1);
    b.look({0, -0.5, 5}, {0, 0, 0}, 20);
    b.description.integrator.max_depth = 1;
    return b;
}

// Of all pixels of pictures of many seeds. The pixels of a replicate of blue-noise samples share a point set,
// so there each seed gives one.
std::vector<double> scores(SceneBuilder& b, double truth, int seeds) {
    const bool shared = b.description.sampler.kind == SamplerKind::sobol_blue_noise;
    if (shared) {
        b.description.film.crop = {3, 2, 4, 3};
        seeds *= 16;
    }
    std::vector<double> z;
    for (int seed = 0; seed < seeds; ++seed) {
        b.description.sampler.seed = static_cast<std::uint64_t>(seed);
        Film film = render(b.description);
        const PixelBounds& c = film.bounds();
        for (int y = c.y0; y < c.y1; ++y)
            for (int x = c.x0; x < c.x1; ++x) z.push_back(normal_score(film.pixel(x, y).replicates(), truth));
    }
    return z;
}

TEST(Calibration, OfEverySampler) {
    for (SamplerKind kind : samplers)
        for (Strategy strategy : {Strategy::light, Strategy::mis}) {
            SceneBuilder b = floor_under_sky();
            b.description.sampler.kind = kind;
            b.description.integrator.strategy = strategy;
            // Enough for the means of eight replicates to be nearly Gaussian.
            b.description.sampler.spp = 512;
            TestResult r = calibration_test(scores(b, 0.6, 10));
            EXPECT_TRUE(r.passes(1e-7)) << "sampler " << int(kind) << ": " << r.description;
        }
}

// Many bounces and Russian roulette, inside a closed surface of albedo 0.6 that emits 1.
TEST(Calibration, OfLongPaths) {
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        SceneBuilder b;
        b.add_quadric(Sphere{}, b.add(DiffuseMaterial{gray(0.6f)}), 1, true);
        b.look({0.2, 0.1, -0.3}, {1, 0, 0}, 60);
        b.description.integrator.max_depth = 200;
        b.description.sampler.kind = kind;
        // Russian roulette makes samples skewed: at 64 of them the truth lies within 3 standard errors
        // in 98.5 %.
        b.description.sampler.spp = 1024;
        TestResult r = calibration_test(scores(b, 2.5, 6));
        EXPECT_TRUE(r.passes(1e-7)) << "sampler " << int(kind) << ": " << r.description;
    }
}

// Mean over pixels of the variance over seeds, in units of the squared mean.
double relative_mse(SceneBuilder& b, SamplerKind kind, std::uint32_t samples, std::uint32_t replicates,
                    int seeds) {
    b.description.sampler.kind = kind;
    b.description.sampler.spp = samples;
    b.description.sampler.replicates = replicates;
    const PixelBounds c = b.description.film.crop;
    std::vector<RunningMoments> pixels(static_cast<std::size_t>(c.width() * c.height()));
    for (int seed = 0; seed < seeds; ++seed) {
        b.description.sampler.seed = static_cast<std::uint64_t>(seed) + 1;
        Film film = render(b.description);
        for (int y = 0; y < c.height(); ++y)
            for (int x = 0; x < c.width(); ++x)
                pixels[static_cast<std::size_t>(y * c.width() + x)].add(
                    film.pixel(x, y).replicates().mean(1));
    }
    double sum = 0;
    for (const RunningMoments& m : pixels) sum += m.variance() / (m.mean() * m.mean());
    return sum / static_cast<double>(pixels.size());
}

// The mixed scene, all diffuse, with the lamp in its ceiling alone: light from there directly and by one
// bounce. Seeds are fixed and tests of ratios of errors, known to about 6 %, leave room for another standard
// library's rounding.
SceneBuilder cornell_box() {
    SceneBuilder b = mixed_scene(1, 12, 12);
    for (Material& m : b.scene.materials)
        if (!std::holds_alternative<DiffuseMaterial>(m)) m = DiffuseMaterial{gray(0.7f)};
    b.scene.lights.resize(1);
    b.scene.shapes.back().light = no_index;
    b.scene.world_shapes.pop_back();
    b.description.integrator.max_depth = 2;
    return b;
}

TEST(Convergence, IndependentErrorFallsAsOneOverN) {
    SceneBuilder b = cornell_box();
    double few = relative_mse(b, SamplerKind::independent, 8, 1, 24);
    double many = relative_mse(b, SamplerKind::independent, 128, 1, 24);
    double slope = std::log(many / few) / std::log(128.0 / 8);
    RecordProperty("slope", std::to_string(slope));
    EXPECT_NEAR(slope, -1, 0.1);
}

// At equal numbers of samples the error is that of twice as many independent ones, or better.
TEST(Convergence, SobolNeedsHalfTheSamplesAtMost) {
    SceneBuilder b = cornell_box();
    double independent = relative_mse(b, SamplerKind::independent, 256, 1, 8);
    double gain = independent / relative_mse(b, SamplerKind::sobol, 256, 2, 8);
    RecordProperty("gain", std::to_string(gain));
    EXPECT_GT(gain, 2);
}

// The price of an error estimate from eight randomisations of an eighth of the points each: with no more than
// 32 points the kinds are closer to independent samples, but none is worse.
TEST(Convergence, EverySamplerBeatsIndependentWithItsDefaultReplicates) {
    SceneBuilder b = cornell_box();
    double independent = relative_mse(b, SamplerKind::independent, 256, 1, 8);
    for (SamplerKind kind : samplers) {
        if (kind == SamplerKind::independent) continue;
        double gain = independent / relative_mse(b, kind, 256, 0, 8);
        RecordProperty("gain of sampler " + std::to_string(int(kind)), std::to_string(gain));
        EXPECT_GT(gain, 1.2) << "sampler " << int(kind);
    }
}

// Means over the quarters of the picture, channel by channel.
struct Quarters {
    double mean[12], variance[12];
};
Quarters quarters(const Film& film) {
    Quarters q{};
    int w = film.bounds().width(), h = film.bounds().height();
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int c = 0; c < 3; ++c) {
                int k = 3 * (2 * (2 * y / h) + 2 * x / w) + c;
                double n = w * h / 4.0;
                q.mean[k] += film.pixel(x, y).replicates().mean(c) / n;
                q.variance[k] += film.pixel(x, y).replicates().variance_of_mean(c) / (n * n);
            }
    return q;
}

TEST(Strategies, AgreeWithEachOther) {
    SceneBuilder b = mixed_scene(1, 16, 16);
    b.description.integrator.max_depth = 3;
    std::map<bool, std::shared_ptr<const PreparedScene>> prepared; // with tables of the map for MIS or not
    std::vector<Quarters> all;
    std::vector<std::string> names;
    for (Strategy s : {Strategy::mis, Strategy::light, Strategy::bsdf, Strategy::uniform})
        for (Heuristic h : {Heuristic::balance, Heuristic::power}) {
            if (s != Strategy::mis && h == Heuristic::power) continue;
            b.description.integrator.strategy = s;
            b.description.integrator.heuristic = h;
            b.description.sampler.seed = all.size();
            // Those that find the lamps by chance are the noisy ones.
            b.description.sampler.spp = s == Strategy::mis || s == Strategy::light ? 400 : 1200;
            auto& of_strategy = prepared[s == Strategy::mis];
            if (!of_strategy) of_strategy = prepared_scene(b.description);
            all.push_back(quarters(render(b.description, of_strategy)));
            names.push_back(std::to_string(int(s)) + '/' + std::to_string(int(h)));
        }
    for (std::size_t i = 1; i < all.size(); ++i) {
        double difference = 0, variance = 0;
        for (int k = 0; k < 12; ++k) {
            double v = all[i].variance[k] + all[0].variance[k];
            EXPECT_NEAR(all[i].mean[k], all[0].mean[k], 5.5 * std::sqrt(v))
                << names[i] << " quarter " << k / 3 << " channel " << k % 3;
            if (k % 3 != 1) continue;
            difference += all[i].mean[k] - all[0].mean[k];
            variance += v;
        }
        RecordProperty("error of strategy " + names[i],
                       std::to_string(std::sqrt(variance) /
                                      (all[0].mean[1] + all[0].mean[4] + all[0].mean[7] + all[0].mean[10])));
        EXPECT_NEAR(difference, 0, 5.5 * std::sqrt(variance)) << names[i] << ", the whole picture";
    }
}

} // namespace
} // namespace montelux::testing
