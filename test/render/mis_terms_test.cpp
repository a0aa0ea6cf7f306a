// The two terms of multiple importance sampling as separate pictures: they follow the paths of the strategy
// mis, and sum to its picture.
#include "test/render/mixed_scene.h"
#include <gtest/gtest.h>

#include "montelux/render/sample_record.h"

namespace montelux::testing {
namespace {

SceneBuilder small_mixed_scene(Strategy strategy, SamplerKind sampler, Heuristic heuristic) {
    SceneBuilder b = mixed_scene(1, 16, 16);
    b.description.sampler.kind = sampler;
    b.description.sampler.spp = 16;
    b.description.sampler.seed = 3;
    b.description.integrator = {.max_depth = 6, .strategy = strategy, .heuristic = heuristic};
    return b;
}

TEST(MisTerms, AddUpToThePictureOfMis) {
    for (const auto& setting : {std::pair{SamplerKind::independent, Heuristic::power},
                                std::pair{SamplerKind::sobol, Heuristic::balance}}) {
        const auto scene = [&](Strategy s) { return small_mixed_scene(s, setting.first, setting.second); };
        const SceneBuilder mis = scene(Strategy::mis);
        const auto prepared = prepared_scene(mis.description);
        const auto picture = [&](Strategy s) { return render(scene(s).description, prepared); };
        const Film both = picture(Strategy::mis), bsdf = picture(Strategy::mis_bsdf),
                   light = picture(Strategy::mis_light);
        double sums[2] = {};
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                for (int c = 0; c < 3; ++c) {
                    const double a = bsdf.pixel(x, y).replicates().mean(c),
                                 b = light.pixel(x, y).replicates().mean(c),
                                 mean = both.pixel(x, y).replicates().mean(c);
                    EXPECT_NEAR(a + b, mean, 2e-5 * std::abs(mean) + 1e-7) << x << ',' << y;
                    sums[0] += a;
                    sums[1] += b;
                }
        // Neither is nearly all of it.
        EXPECT_GT(sums[0], 0.1 * sums[1]);
        EXPECT_GT(sums[1], 0.1 * sums[0]);
    }
}

// The record of a term has the weights of mis, and says what it leaves out.
TEST(MisTerms, FollowThePathsOfMis) {
    const auto make = [](Strategy s) {
        return small_mixed_scene(s, SamplerKind::independent, Heuristic::power);
    };
    const SceneBuilder both = make(Strategy::mis), bsdf = make(Strategy::mis_bsdf),
                       light = make(Strategy::mis_light);
    const Renderer a(both.description), b(bsdf.description), c(light.description);
    int found = 0, seen = 0, sampled = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const PathRecord m = a.replay(x, y, 1).path, f = b.replay(x, y, 1).path,
                             s = c.replay(x, y, 1).path;
            ASSERT_EQ(m.vertices.size(), f.vertices.size());
            ASSERT_EQ(m.vertices.size(), s.vertices.size());
            EXPECT_EQ(m.end, f.end);
            EXPECT_EQ(m.end, s.end);
            for (std::size_t i = 0; i < m.vertices.size(); ++i) {
                const PathVertex &vm = m.vertices[i], &vf = f.vertices[i], &vs = s.vertices[i];
                EXPECT_EQ(vm.ray.d, vf.ray.d);
                EXPECT_EQ(vm.ray.d, vs.ray.d);
                ASSERT_EQ(vm.found.size(), vf.found.size());
                ASSERT_EQ(vm.found.size(), vs.found.size());
                for (std::size_t k = 0; k < vm.found.size(); ++k) {
                    ++(vm.found[k].shared ? found : seen);
                    EXPECT_TRUE(vf.found[k].counted);
                    EXPECT_EQ(vf.found[k].contribution, vm.found[k].contribution);
                    EXPECT_FALSE(vs.found[k].counted);
                    EXPECT_EQ(vs.found[k].contribution, SampledSpectrum());
                    EXPECT_EQ(vs.found[k].weight, vm.found[k].weight);
                }
                ASSERT_EQ(vm.direct.has_value(), vf.direct.has_value());
                ASSERT_EQ(vm.direct.has_value(), vs.direct.has_value());
                if (!vm.direct || vm.direct->outcome != DirectLight::Outcome::counted) continue;
                ++sampled;
                EXPECT_EQ(vf.direct->outcome, DirectLight::Outcome::other_term);
                EXPECT_EQ(vf.direct->contribution, SampledSpectrum());
                EXPECT_EQ(vf.direct->weight, vm.direct->weight);
                EXPECT_EQ(vs.direct->outcome, DirectLight::Outcome::counted);
                EXPECT_EQ(vs.direct->contribution, vm.direct->contribution);
            }
        }
    EXPECT_GT(found, 20);
    EXPECT_GT(seen, 5);
    EXPECT_GT(sampled, 20);
}

// Light that only one technique can find is entirely in that technique's term.
TEST(MisTerms, LampsThatNothingMeetsAndLightThatTheCameraSees) {
    auto mean = [](SceneBuilder b, Strategy strategy) {
        b.description.integrator.strategy = strategy;
        const Film film = render(b.description);
        double sum = 0;
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) sum += film.pixel(x, y).replicates().mean(1);
        return sum / 64;
    };
    SceneBuilder lamp;
    lamp.add_mesh(square(Transform::scale({100, 100, 1})), lamp.add(DiffuseMaterial{gray(0.6f)}));
    lamp.scene.lights.push_back(PointLight{white_light(lamp.scene), white_scale(), {0, 0, 3}});
    lamp.look({0, -0.5, 5}, {0, 0, 0}, 20);
    lamp.description.integrator.max_depth = 1;
    EXPECT_EQ(mean(lamp, Strategy::mis_bsdf), 0);
    EXPECT_GT(mean(lamp, Strategy::mis_light), 0);
    EXPECT_EQ(mean(lamp, Strategy::mis_light), mean(lamp, Strategy::mis));

    SceneBuilder sky;
    sky.add_uniform_light(1);
    sky.look({0, -0.5, 5}, {0, 0, 9}, 20);
    EXPECT_NEAR(mean(sky, Strategy::mis_bsdf), 1, 0.05);
    EXPECT_EQ(mean(sky, Strategy::mis_bsdf), mean(sky, Strategy::mis));
    EXPECT_EQ(mean(sky, Strategy::mis_light), 0);
}

} // namespace
} // namespace montelux::testing
