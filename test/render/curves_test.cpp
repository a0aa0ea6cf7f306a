// Curves in pictures. Comparisons at 5 standard errors (a false alarm in 1.7 million) plus rounding.
#include "test/render/scene_testing.h"
#include <array>
#include <gtest/gtest.h>

namespace montelux::testing {
namespace {

Curves strands(Curves::Kind kind) {
    Curves curves;
    curves.kind = kind;
    for (int i = 0; i < 30; ++i) {
        const float x = -0.9f + 0.06f * static_cast<float>(i), bend = 0.2f * static_cast<float>(i % 3);
        curves.control_points.push_back(
            {Point3f{x, -1, bend}, {x + bend, -0.3f, 0}, {x - bend, 0.3f, 0}, {x, 1, -bend}});
        curves.widths.push_back({0.1f, 0.05f});
        if (kind == Curves::Kind::ribbon) curves.normals.push_back({Normal3f{0, 0, 1}, {0.6f, 0, 0.8f}});
    }
    return curves;
}

void add(SceneBuilder& b, const Curves& curves, const Material& m) {
    const Index material = b.add(m);
    CallMessages messages("scene of a test");
    montelux::SceneBuilder(b.scene, messages).add_shape(curves, {.material = material});
}

HairMaterial hair_without_absorption() {
    HairMaterial m;
    m.color.source = HairColorParameter::absorption;
    m.color.sigma_a = gray(0);
    return m;
}

// Hair that absorbs nothing vanishes in front of uniform light.
TEST(CurvesPicture, WhiteFurnaceOfHair) {
    for (const Curves::Kind kind : {Curves::Kind::flat, Curves::Kind::cylinder, Curves::Kind::ribbon}) {
        SceneBuilder b;
        b.add_uniform_light(1);
        b.look({0, 0, 4}, {0, 0, 0}, 20);
        b.description.integrator.max_depth = 400;
        add(b, strands(kind), hair_without_absorption());
        const PictureMean m = picture_mean(render(b.description));
        EXPECT_NEAR(m.mean, 1, 5 * m.standard_error + 2e-3);
        EXPECT_LT(m.standard_error, 0.02);
    }
}

// The means of the two halves of a picture, of a wide curve seen along -z and lit from the side.
std::array<double, 2> halves(Curves::Kind kind, const Material& m, float light_x, float up) {
    SceneBuilder b;
    Curves curves;
    curves.kind = kind;
    curves.control_points = {{Point3f{0, -3 * up, 0}, {0, -up, 0}, {0, up, 0}, {0, 3 * up, 0}}};
    curves.widths = {{2, 2}};
    add(b, curves, m);
    b.scene.lights.push_back(DistantLight{.spectrum = white_light(b.scene),
                                          .scale = white_scale(),
                                          .to_light = normalize(Vec3f{light_x, 0, 1})});
    b.look({0, 0, 20}, {0, 0, 0}, 5);
    const Film film = render(b.description);
    std::array<double, 2> sums{};
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) sums[x / 4] += film.pixel(x, y).replicates().mean(1) / 32;
    return sums;
}

// The side of pbrt-v4's curves, to which its pictures are compared: hair that only reflects, on a flat curve,
// is bright where a matt cylinder is dark (docs/pbrt.md).
TEST(CurvesPicture, HairShinesOnTheSideOfPbrt) {
    HairMaterial hair;
    hair.color.source = HairColorParameter::absorption;
    hair.color.sigma_a = gray(1e4f);
    for (const float light_x : {1.0f, -1.0f})
        for (const float up : {1.0f, -1.0f}) { // the hair runs up or down
            const auto matt = halves(Curves::Kind::cylinder, DiffuseMaterial{gray(0.5f)}, light_x, up),
                       shiny = halves(Curves::Kind::flat, hair, light_x, up);
            const std::size_t lit = matt[0] > matt[1] ? 0 : 1;
            EXPECT_GT(matt[lit], 1.5 * matt[1 - lit]);
            EXPECT_GT(shiny[1 - lit], 10 * shiny[lit]) << light_x << ' ' << up;
        }
}

} // namespace
} // namespace montelux::testing
