// One light among very many is chosen as often as its probability says.
#include "test/render/mixed_scene.h"
#include <gtest/gtest.h>

namespace montelux::testing {
namespace {

// The many emit away from the floor. With 24 bits for the choice the lamp would be 8 % too dark: 8 standard
// errors and more; the comparison is at 5 (a false alarm in 1.7 million).
TEST(ManyLights, OneAmongThemIsAsBrightAsAlone) {
    constexpr int many = 1 << 18;
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({100, 100, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    TriangleMesh heap;
    heap.positions = {{0, 0, -1}, {0, 1, -1}, {1, 0, -1}};
    for (int i = 0; i < many; ++i) heap.indices.insert(heap.indices.end(), {0, 1, 2});
    b.add_mesh(std::move(heap), b.add(DiffuseMaterial{gray(0)}), 1);
    const double heap_power = pi * 0.5 * many;
    // A tenth of the power is its.
    const double intensity = heap_power / 9 / (4 * pi);
    b.scene.lights.push_back(
        PointLight{white_light(b.scene), static_cast<float>(intensity) * white_scale(), {0, 0, 10}});
    b.description.integrator.max_depth = 1;
    b.description.sampler.spp = 4096;
    b.look({0, -0.1, 5}, {0, 0, 0}, 0.05f);
    const double truth = 0.6 / pi * intensity / 100;
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        const PictureMean m = picture_mean(render(b.description));
        EXPECT_NEAR(m.mean, truth, 5 * m.standard_error);
        EXPECT_LT(m.standard_error, 0.01 * truth);
    }
}

// However lights are chosen, the picture is the same within its errors: 5 standard errors of the difference of
// two means.
TEST(ManyLights, AnyChoiceOfLightsGivesTheSamePicture) {
    SceneBuilder b = mixed_scene(1, 16, 16);
    b.description.sampler.spp = 256;
    for (const Strategy strategy : {Strategy::light, Strategy::mis}) {
        b.description.integrator.strategy = strategy;
        b.description.integrator.light_sampling = LightSampling::power;
        const PictureMean power = picture_mean(render(b.description));
        b.description.integrator.light_sampling = LightSampling::uniform;
        b.description.sampler.seed += 1;
        const PictureMean uniform = picture_mean(render(b.description));
        EXPECT_NEAR(power.mean, uniform.mean, 5 * std::hypot(power.standard_error, uniform.standard_error));
        EXPECT_LT(uniform.standard_error, 0.02 * uniform.mean);
        EXPECT_NE(power.mean, uniform.mean);
    }
}

} // namespace
} // namespace montelux::testing
