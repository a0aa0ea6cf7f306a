// Manifold sampling from surfaces that are almost mirrors: lamps are left to scattering, points of light are not.
#include "test/render/agreement.h"
#include "test/render/mixed_scene.h"
#include <cmath>
#include <gtest/gtest.h>

namespace montelux::testing {
namespace {

ConductorMaterial metal(float alpha) {
    return {.metal = {.eta = gray(0.2f), .k = gray(3)}, .roughness = alpha_of(alpha)};
}

// A polished floor, on which a mirror at x = 2 shows what is at (4, 0, 2) in its image.
SceneBuilder polished_floor(float alpha) {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({3, 3, 1})), b.add(metal(alpha)));
    b.add_mesh(square(Transform::translate({2, 0, 2}) * Transform::rotate(-90, {0, 1, 0}) *
                      Transform::scale({2, 2, 1})),
               b.add(metal(0)));
    b.look({-2, 0, 1}, {0, 0, 0}, 10);
    b.description.integrator.max_depth = 3;
    b.description.sampler.spp = 256;
    return b;
}
PictureMean mean_of(const SceneBuilder& b, bool manifolds) {
    SceneDescription d = b.description;
    d.integrator.manifold_sampling = manifolds;
    return picture_mean(render(d));
}

TEST(ManifoldNarrowLobes, LampsAreFoundByScattering) {
    for (const float alpha : {0.002f, 0.015f, 0.1f}) {
        SceneBuilder b = polished_floor(alpha);
        b.add_mesh(square(Transform::translate({0, 0, 2}) * Transform::rotate(180, {1, 0, 0}) *
                          Transform::scale({0.4, 0.4, 1})),
                   b.add(DiffuseMaterial{gray(0)}), 3);
        const PictureMean by_paths = mean_of(b, false), by_manifolds = mean_of(b, true);
        EXPECT_GT(by_paths.mean, 0.1);
        EXPECT_LT(by_manifolds.standard_error, 0.02 * by_paths.mean) << alpha;
        EXPECT_LT(std::abs(by_manifolds.mean - by_paths.mean),
                  5 * std::hypot(by_manifolds.standard_error, by_paths.standard_error))
            << alpha << ": " << by_manifolds.mean << " " << by_paths.mean;
    }
}

TEST(ManifoldNarrowLobes, PointsOfLightAreFoundByManifoldsAlone) {
    SceneBuilder b = polished_floor(0.015f);
    b.scene.lights.push_back(PointLight{white_light(b.scene), white_scale(), {0, 0, 2}});
    const PictureMean by_paths = mean_of(b, false), by_manifolds = mean_of(b, true);
    EXPECT_GT(by_manifolds.mean, 10 * by_paths.mean);
    EXPECT_LT(by_manifolds.standard_error, 0.1 * by_manifolds.mean);
}

} // namespace
} // namespace montelux::testing
