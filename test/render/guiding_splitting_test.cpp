// Paths that a guide splits: trees of bounded size, with the same mean and the same bits in any batch.
#include "test/render/hidden_lamp.h"
#include "test/render/mixed_scene.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "montelux/mc/stats/moments.h"
#include "montelux/render/guide_training.h"
#include "montelux/transport/guiding/guiding_learner.h"

namespace montelux::testing {
namespace {

// The slit is a window whose index of refraction depends on the wavelength: behind it a path has one left. A whole wall
// shines, for light samples do not reach through the window.
SceneBuilder lamp_behind_prism(int size, double slit = 0.2) {
    SceneBuilder b = hidden_lamp(size, 0.7f, slit);
    const Spectrum flint(PiecewiseLinear::from_pairs(std::array{360.0f, 1.9f, 830.0f, 1.4f}));
    b.add_mesh(square(Transform::translate({1.9, 0, 0}) * Transform::rotate(-90, {0, 1, 0})),
               b.add(DiffuseMaterial{gray(0)}), 4);
    const Index glass = b.add(DielectricMaterial{add_spectrum(b.scene, flint), alpha_of(0)});
    for (const double side : {-1, 1})
        b.add_mesh(square(Transform::translate({0.8 + 0.01 * side, 1 - slit / 2, 0}) *
                          Transform::rotate(90 * side, {0, 1, 0}) * Transform::scale({1, slit / 2, 1})),
                   glass);
    return b;
}
SceneBuilder lamp_in_fog(int size, double slit = 0.2) {
    SceneBuilder b = hidden_lamp(size, 0.7f, slit);
    b.scene.media.push_back(HomogeneousMedium{.sigma_a = 0.02f, .sigma_s = 0.3f});
    b.scene.camera.medium = 0;
    return b;
}

// Samples with a guide that is trained here, and without it.
class Guided {
  public:
    explicit Guided(SceneBuilder b)
        : description_(prepared(std::move(b.description))), renderer_(description_), guided_(context()),
          plain_(context()), tracer_(renderer_.accelerator()) {
        train_guide(guided_, renderer_.accelerator(), description_.integrator,
                    {.bounds = description_.film.crop, .samples = 64});
    }
    std::vector<SampleContext::Key> keys(std::uint64_t samples) const {
        std::vector<SampleContext::Key> keys;
        for (int y = 0; y < description_.film.height; ++y)
            for (int x = 0; x < description_.film.width; ++x)
                for (std::uint64_t s = 0; s < samples; ++s) keys.push_back({x, y, s});
        return keys;
    }
    std::vector<SampleContext::Result> take(std::span<const SampleContext::Key> keys, bool guided = true) {
        std::vector<SampleContext::Result> results(keys.size());
        (guided ? guided_ : plain_).take(tracer_, keys, batch_, results);
        return results;
    }
    // Of the samples that were taken last, in a scene without media.
    std::vector<int> branches(std::size_t samples) const {
        std::vector<int> count(samples, 1);
        for (const PathBatch::Origin& o : batch_.integrator.path.origins) ++count[o.sample];
        return count;
    }
    // Samples that are not split.
    std::vector<SampleContext::Lesson> teach(std::span<const SampleContext::Key> keys, bool guided,
                                             std::vector<GuidingRecord>& records) {
        std::vector<SampleContext::Lesson> lessons(keys.size());
        (guided ? guided_ : plain_)
            .teach(
                tracer_, keys, batch_, lessons, [](std::size_t) { return true; }, records);
        return lessons;
    }
    // From now on a guide that has learned the same, and expects next to nothing of each pixel.
    void expect_little() {
        const std::vector<SampleContext::Key> all = keys(16);
        std::array<std::vector<GuidingRecord>, 1> records;
        teach(all, true, records[0]);
        const PixelBounds& bounds = description_.film.crop;
        guided_.set_guide(std::make_shared<const GuidingField>(
            GuidingLearner::learn(records, {}, bounds, std::vector<float>(keys(1).size(), 1e-6f))));
    }
    std::uint64_t rays() const { return tracer_.statistics.rays(); }
    // Of the samples with these keys.
    double shadow_rays_per_ray(std::span<const SampleContext::Key> keys, bool guided) {
        const RayStatistics before = tracer_.statistics;
        take(keys, guided);
        return static_cast<double>(tracer_.statistics.occlusion - before.occlusion) /
               static_cast<double>(tracer_.statistics.closest - before.closest);
    }
    bool has_guide() const { return guided_.guide() != nullptr; }
    const IntegratorSettings& settings() const { return description_.integrator; }

  private:
    static SceneDescription prepared(SceneDescription d) {
        d.integrator.guiding = Guiding::on;
        d.sampler.kind = SamplerKind::independent;
        return d;
    }
    SampleContext context() const {
        return {description_, renderer_.sampler(), renderer_.scene(), renderer_.camera()};
    }

    SceneDescription description_;
    Renderer renderer_;
    SampleContext guided_, plain_;
    RayTracer tracer_;
    SampleContext::Batch batch_;
};

TEST(GuidingSplits, SamplesAreTrees) {
    Guided guided(hidden_lamp(16));
    ASSERT_TRUE(guided.has_guide());
    const std::vector<SampleContext::Key> keys = guided.keys(16);
    guided.take(keys);
    const std::vector<int> branches = guided.branches(keys.size());
    EXPECT_GT(std::ranges::count_if(branches, [](int n) { return n > 1; }),
              static_cast<std::ptrdiff_t>(keys.size() / 20));
}

// Nearly all light samples are occluded, and most that are not are weak.
TEST(GuidingSplits, LightSamplesOfHiddenLampsAreRarelyTraced) {
    Guided guided(hidden_lamp(16));
    ASSERT_TRUE(guided.has_guide());
    const std::vector<SampleContext::Key> keys = guided.keys(16);
    EXPECT_LT(guided.shadow_rays_per_ray(keys, true), 0.75 * guided.shadow_rays_per_ray(keys, false));
}

// Where pixels expect next to nothing, every vertex would like to split.
TEST(GuidingSplits, TreesAreBounded) {
    Guided guided(hidden_lamp(12));
    guided.expect_little();
    const std::vector<SampleContext::Key> keys = guided.keys(8);
    guided.take(keys);
    const std::vector<int> branches = guided.branches(keys.size());
    EXPECT_EQ(std::ranges::max(branches), most_branches_of_sample);

    Guided foggy(lamp_in_fog(12));
    foggy.expect_little();
    // Of one path: a ray, a shadow ray from its end, and one from a point on it. Nothing here is passed.
    const std::uint64_t path = 3 * (static_cast<std::uint64_t>(foggy.settings().max_depth) + 1);
    std::uint64_t most = 0;
    for (const SampleContext::Key& key : foggy.keys(2)) {
        const std::uint64_t before = foggy.rays();
        foggy.take({&key, 1});
        most = std::max(most, foggy.rays() - before);
    }
    EXPECT_GT(most, 4 * path);
    EXPECT_LE(most, path * most_branches_of_sample);
}

// What glossy surfaces scatter depends on the direction: no mean tells how much a path brings from there.
TEST(GuidingSplits, GlossySurfacesDoNotSplit) {
    SceneBuilder b = hidden_lamp(12);
    for (Material& m : b.scene.materials)
        m = ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(4)}, .roughness = alpha_of(0.3f)};
    for (const bool fog : {false, true}) {
        if (fog) {
            b.scene.media.push_back(HomogeneousMedium{.sigma_s = 1e-6f});
            b.scene.camera.medium = 0;
        }
        Guided guided(b);
        guided.expect_little();
        const std::vector<SampleContext::Key> keys = guided.keys(8);
        // Of one path: a ray, a shadow ray from its end, and one from a point on it.
        const std::uint64_t path = 3 * (static_cast<std::uint64_t>(guided.settings().max_depth) + 1);
        std::uint64_t most = 0;
        for (const SampleContext::Key& key : keys) {
            const std::uint64_t before = guided.rays();
            guided.take({&key, 1});
            most = std::max(most, guided.rays() - before);
        }
        EXPECT_LE(most, path) << fog;
        guided.take(keys);
        if (!fog) {
            EXPECT_EQ(std::ranges::max(guided.branches(keys.size())), 1);
        }
    }
}

// A clear pane in the slit costs little more than the light samples that it stops: between guided vertices roulette goes by
// what is lost there. If it went by the little that paths carry into bright places, the ratio would be 2.4.
TEST(GuidingSplits, ClearPanesDoNotEndPaths) {
    const auto mean_square = [](bool pane) {
        SceneBuilder b = hidden_lamp(16);
        b.description.integrator.max_depth = 24;
        if (pane)
            b.add_mesh(square(Transform::translate({0.8, 0.9, 0}) * Transform::rotate(90, {0, 1, 0}) *
                              Transform::scale({1, 0.1, 1})),
                       b.add(ThinDielectricMaterial{1.0001f}));
        Guided guided(b);
        RunningMoments squares;
        for (const SampleContext::Result& r : guided.take(guided.keys(64)))
            squares.add(std::pow(double(max_component(r.film.radiance)), 2));
        return squares.mean();
    };
    const double with = mean_square(true), without = mean_square(false);
    EXPECT_LT(with, 2.1 * without) << with << " " << without;
}

// A lit corner on black takes a hundredth of the picture: its pixels are a hundred times brighter than that, and expect
// what their paths bring.
TEST(GuidingSplits, BrightObjectsOnBlackExpectTheirLight) {
    SceneBuilder b = hidden_lamp(64);
    b.scene = Scene{};
    const Index white = b.add(DiffuseMaterial{gray(0.8f)});
    b.add_mesh(square(Transform()), white);
    b.add_mesh(square(Transform::translate({0, 1, 1}) * Transform::rotate(90, {1, 0, 0})), white);
    b.add_mesh(square(Transform::translate({0, 0, 3}) * Transform::rotate(180, {1, 0, 0})),
               b.add(DiffuseMaterial{gray(0)}), 5);
    b.look({0, -20, 12}, {0, 0, 0.5}, 45);
    Guided guided(b);
    ASSERT_TRUE(guided.has_guide());
    const std::vector<SampleContext::Key> keys = guided.keys(8);
    guided.take(keys);
    std::ptrdiff_t split = 0, of_corner = 0;
    const std::vector<int> branches = guided.branches(keys.size());
    const std::vector<SampleContext::Result> results = guided.take(keys);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!(max_component(results[i].film.radiance) > 0)) continue;
        ++of_corner;
        split += branches[i] > 1;
    }
    EXPECT_GT(of_corner, 200);
    EXPECT_LT(of_corner, static_cast<std::ptrdiff_t>(keys.size() / 50));
    EXPECT_LT(split, of_corner / 4);
}

// Whatever else is in the batch, and in any order: so threads, ranks and resumed renders get the same bits.
TEST(GuidingSplits, SamplesHaveTheSameBitsInAnyBatch) {
    for (const SceneBuilder& b : {hidden_lamp(12), lamp_behind_prism(12), lamp_in_fog(12)}) {
        Guided guided(b);
        std::vector<SampleContext::Key> keys = guided.keys(4);
        const auto together = guided.take(keys);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const auto alone = guided.take({&keys[i], 1});
            ASSERT_EQ(alone[0].film.radiance, together[i].film.radiance) << i;
        }
        std::ranges::reverse(keys);
        auto reversed = guided.take(keys);
        std::ranges::reverse(reversed);
        for (std::size_t i = 0; i < keys.size(); ++i)
            ASSERT_EQ(reversed[i].film.radiance, together[i].film.radiance) << i;
    }
}

// A box whose small lamp a block hides from half of the floor: a guide aims at the lamp as light samples do.
SceneBuilder half_hidden_lamp(int size) {
    SceneBuilder b = hidden_lamp(size, 0.15f, 1.9);
    b.add_mesh(square(Transform::translate({0, 0.3, 0.9}) * Transform::rotate(180, {1, 0, 0}) *
                      Transform::scale({0.05, 0.05, 1})),
               b.add(DiffuseMaterial{gray(0)}), 200);
    b.add_mesh(square(Transform::translate({-0.2, 0.3, 0.3}) * Transform::scale({0.2, 0.2, 1})),
               b.add(DiffuseMaterial{gray(0.5f)}));
    return b;
}

// Guided samples estimate the second moment of unguided samples. 4 tests at 5 standard errors: 2e-6.
TEST(GuidingGain, GuidedSamplesTellTheSecondMomentOfOthers) {
    struct Case {
        SceneBuilder scene;
        std::uint64_t samples; // per pixel, for an error of a few per cent
    };
    for (const Case& c : std::array{Case{hidden_lamp(8, 0.7f, 0.6), 2048}, Case{half_hidden_lamp(8), 512},
                                    Case{lamp_in_fog(8, 1.6), 8192}, Case{mixed_scene(), 64}}) {
        Guided guided(c.scene);
        ASSERT_TRUE(guided.has_guide());
        std::vector<GuidingRecord> records;
        RunningMoments foretold, with, without;
        for (const auto& l : guided.teach(guided.keys(c.samples), true, records)) {
            foretold.add(l.unguided_square);
            with.add(double(l.radiance) * double(l.radiance));
        }
        for (const auto& l : guided.teach(guided.keys(2 * c.samples), false, records)) {
            const double square = double(l.radiance) * double(l.radiance);
            ASSERT_NEAR(l.unguided_square, square, 1e-4 * square); // exact for unguided samples
            without.add(square);
        }
        const double error = std::hypot(foretold.standard_error(), without.standard_error());
        EXPECT_LT(std::abs(foretold.mean() - without.mean()), 5 * error)
            << foretold.mean() << " " << without.mean() << " " << with.mean();
        EXPECT_LT(error, 0.05 * without.mean());
    }
}

// 12 tests at 5 standard errors: 7e-6.
TEST(GuidingSplits, MeansAreThoseOfSinglePaths) {
    // A wide slit, so that paths without a guide have little noise.
    constexpr double slit = 1;
    struct Case {
        SceneBuilder scene;
        std::uint64_t samples; // per pixel, for an error of a few per cent
    };
    for (const Case& c :
         std::array{Case{hidden_lamp(16, 0.7f, slit), 128}, Case{lamp_behind_prism(16, 1.6), 192},
                    Case{lamp_in_fog(16, slit), 128}, Case{mixed_scene(), 64}}) {
        Guided guided(c.scene);
        const std::vector<SampleContext::Key> keys = guided.keys(c.samples);
        Moments3 with, without;
        for (const auto& r : guided.take(keys)) with.add(r.film.radiance);
        for (const auto& r : guided.take(keys, false)) without.add(r.film.radiance);
        for (int channel = 0; channel < 3; ++channel) {
            const double error = std::hypot(with.standard_error(channel), without.standard_error(channel));
            EXPECT_LT(std::abs(with.mean(channel) - without.mean(channel)), 5 * error)
                << with.mean(channel) << " " << without.mean(channel);
            EXPECT_LT(error, 0.05 * without.mean(channel)); // so that a bias would be seen
        }
    }
}

// Nearly every path that reaches the window has been split.
TEST(GuidingSplits, MeansAreThoseOfSinglePathsWhereBranchesLoseWavelengths) {
    Guided guided(lamp_behind_prism(8, 1.6));
    guided.expect_little();
    const std::vector<SampleContext::Key> keys = guided.keys(128), more = guided.keys(1024);
    Moments3 with, without;
    for (const auto& r : guided.take(keys)) with.add(r.film.radiance);
    for (const auto& r : guided.take(more, false)) without.add(r.film.radiance);
    for (int c = 0; c < 3; ++c) {
        const double error = std::hypot(with.standard_error(c), without.standard_error(c));
        EXPECT_LT(std::abs(with.mean(c) - without.mean(c)), 5 * error)
            << with.mean(c) << " " << without.mean(c);
        EXPECT_LT(error, 0.05 * without.mean(c));
    }
}

} // namespace
} // namespace montelux::testing
