// Media of extinction and albedo on grids: their values in space, and radiance known from algebra.
#include "test/transport/volume_testing.h"
#include <algorithm>

#include "montelux/mc/stats/chi_squared.h"

namespace montelux::testing {
namespace {

AffineMap unit_from_cube(const Transform& turn = {}) {
    return AffineMap(Transform::translate({0.5, 0.5, 0.5}) * Transform::scale({0.5, 0.5, 0.5}) * turn);
}

// In the cube [-1, 1]^3.
FieldMedium field_medium(const MediumField& extinction, const MediumField& albedo) {
    FieldMedium m;
    m.box.p0 = {-1, -1, -1};
    m.box.p1 = {1, 1, 1};
    m.extinction = extinction;
    m.albedo = albedo;
    return m;
}
MediumField scalars(Index grid, const Transform& turn = {}) {
    return {.scalars = grid, .unit_from_world = unit_from_cube(turn)};
}

MediumPoint coefficients(VolumeScene& b, const FieldMedium& m, Point3f p) {
    b.scene.media = {m};
    const SceneTables tables(b.scene);
    return m.at(tables.view(), 0, SampledWavelengths::sample_visible(0.37f)).coefficients(p);
}

TEST(FieldMedium, GridsGoOnBeyondTheirSamples) {
    VolumeScene b;
    FieldMedium m = field_medium(scalars(b.add_grid(1, 1, 2, {1, 3})), {.value = 0.25f});
    m.scale = 2;
    const auto extinction = [&](float z) {
        const MediumPoint p = coefficients(b, m, {0.9f, -0.9f, z});
        EXPECT_FLOAT_EQ(p.sigma_s[0], 0.25f * (p.sigma_a[0] + p.sigma_s[0]));
        return p.sigma_a[0] + p.sigma_s[0];
    };
    EXPECT_FLOAT_EQ(extinction(-0.9f), 2);
    EXPECT_FLOAT_EQ(extinction(0), 4);
    EXPECT_FLOAT_EQ(extinction(0.9f), 6);
    m.extinction.nearest = true;
    EXPECT_FLOAT_EQ(extinction(-0.01f), 2);
    EXPECT_FLOAT_EQ(extinction(0.01f), 6);
}

TEST(FieldMedium, GridsMayRepeatOrBeMirroredBeyondTheirSamples) {
    VolumeScene b;
    const MediumField albedo = scalars(b.add_grid(1, 1, 4, {0.1f, 0.2f, 0.3f, 0.5f}));
    FieldMedium m = field_medium({.value = 1}, albedo);
    m.bounded = false;
    const auto at = [&](float sample, GridWrap wrap, bool nearest) { // of the row
        m.albedo.wrap = wrap;
        m.albedo.nearest = nearest;
        return coefficients(b, m, {0.9f, -0.9f, (sample + 0.5f) / 2 - 1}).sigma_s[0];
    };
    // The half-way point between a border and what stands beyond it; then far beyond.
    EXPECT_FLOAT_EQ(at(-0.5f, GridWrap::clamp, false), 0.1f);
    EXPECT_FLOAT_EQ(at(-0.5f, GridWrap::repeat, false), 0.3f);
    EXPECT_FLOAT_EQ(at(-0.5f, GridWrap::mirror, false), 0.1f);
    EXPECT_FLOAT_EQ(at(3.5f, GridWrap::repeat, false), 0.3f);
    EXPECT_FLOAT_EQ(at(3.5f, GridWrap::mirror, false), 0.5f);
    EXPECT_FLOAT_EQ(at(6.5f, GridWrap::repeat, false), 0.4f);
    EXPECT_FLOAT_EQ(at(6.5f, GridWrap::mirror, false), 0.15f);
    EXPECT_FLOAT_EQ(at(-9.75f, GridWrap::repeat, true), 0.3f);
    EXPECT_FLOAT_EQ(at(-9.75f, GridWrap::mirror, true), 0.2f);
    EXPECT_FLOAT_EQ(at(-9.75f, GridWrap::clamp, true), 0.1f);
}

// Majorants near a face bound what is repeated there.
TEST(FieldMedium, MajorantsBoundWhatWrapsAround) {
    VolumeScene b;
    FieldMedium m =
        field_medium(scalars(b.add_grid(1, 1, 32, std::vector<float>(31, 0.0f))), {.value = 0.25f});
    b.scene.scalar_grids.back().values.push_back(5);
    m.extinction.wrap = GridWrap::repeat;
    b.scene.media = {m};
    const SceneTables tables(b.scene);
    const MediumTable& table = tables.view().medium_tables[0];
    EXPECT_GE(table.majorants.values.front(), 2.5f);
    m.extinction.wrap = GridWrap::clamp;
    b.scene.media = {m};
    EXPECT_EQ(SceneTables(b.scene).view().medium_tables[0].majorants.values.front(), 0);
}

TEST(FieldMedium, AlbedoHasAPlaceOfItsOwn) {
    VolumeScene b;
    // Along x, where the extinction varies along z.
    FieldMedium m =
        field_medium(scalars(b.add_grid(1, 1, 2, {1, 3})),
                     scalars(b.add_grid(1, 1, 2, {0.2f, 0.8f}), Transform::rotate(-90, {0, 1, 0})));
    const MediumPoint p = coefficients(b, m, {0.9f, 0, -0.9f});
    EXPECT_FLOAT_EQ(p.sigma_s[0], 0.8f);
    EXPECT_FLOAT_EQ(p.sigma_a[0], 0.2f);
    m.albedo.colors = 0;
    m.albedo.scalars = no_index;
    ColorGrid& colors = b.scene.color_grids.emplace_back();
    colors.size = {1, 1, 1};
    const RgbUnboundedSpectrum red(RgbColorSpace::srgb(), {0.9f, 0.2f, 0.1f});
    colors.values.push_back(red);
    const SampledSpectrum expected = red.sample(SampledWavelengths::sample_visible(0.37f));
    const MediumPoint q = coefficients(b, m, {0.9f, 0, -0.9f});
    for (int i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(q.sigma_s[i], std::min(expected[i], 1.0f));
}

// The mean of the samples along the ray: with values of 0 beyond them it would be less.
TEST(FieldMedium, AbsorbingCube) {
    for (const bool nearest : {false, true}) {
        VolumeScene b;
        FieldMedium m = field_medium(scalars(b.add_grid(1, 1, 2, {0.2f, 0.8f})), {.value = 0.0f});
        m.extinction.nearest = nearest;
        b.add_cube(b.add_medium(m));
        b.add_sky();
        expect_radiance(
            volume_radiance(b.description, {{0.1f, 0.2f, -3}, {0, 0, 1}}, 2000),
            [](float) { return std::exp(-2 * 0.5); }, nearest ? "nearest" : "interpolated");
    }
}

// An unbounded one with the same albedo everywhere is a homogeneous medium.
TEST(FieldMedium, UnboundedSlab) {
    const auto mean = [](bool by_grid) {
        VolumeScene b;
        FieldMedium m = field_medium({.value = b.spectrum(0.3f, 1.2f)}, {.value = 0.6f});
        m.bounded = false;
        if (by_grid) m.albedo = scalars(b.add_grid(2, 1, 1, {0.6f, 0.6f}));
        b.add_slab(b.add_medium(m), 2);
        b.add_sky();
        b.description.integrator.max_depth = 2;
        return volume_radiance(b.description, {{0.1f, 0.2f, -3}, {0, 0, 1}}, 1600);
    };
    VolumeScene b;
    b.add_slab(b.add_medium(HomogeneousMedium{.sigma_a = b.spectrum(0.4f * 0.3f, 0.4f * 1.2f),
                                              .sigma_s = b.spectrum(0.6f * 0.3f, 0.6f * 1.2f)}),
               2);
    b.add_sky();
    b.description.integrator.max_depth = 2;
    const SpectralMean expected = volume_radiance(b.description, {{0.1f, 0.2f, -3}, {0, 0, 1}}, 1600);
    for (const bool by_grid : {false, true})
        expect_same_mean(mean(by_grid).total, expected.total, by_grid ? "grid" : "constant");
}

// What only scatters cannot be seen against uniform light, wherever the turned grid has its peaks.
TEST(FieldMedium, FurnaceOfATurnedGrid) {
    VolumeScene b;
    ColorGrid& colors = b.scene.color_grids.emplace_back();
    colors.size = {5, 4, 3};
    for (int i = 0; i < 5 * 4 * 3; ++i)
        colors.values.push_back(RgbUnboundedSpectrum(
            RgbColorSpace::srgb(), {0.1f * static_cast<float>(i * i * 7 % 11), 0.4f, 0.9f}));
    const MediumField extinction{.colors = 0,
                                 .unit_from_world = unit_from_cube(Transform::rotate(30, {1, 2, 3}))};
    FieldMedium m = field_medium(extinction, {.value = 1.0f});
    m.scale = 5;
    b.add_cube(b.add_medium(m));
    b.add_sky();
    expect_radiance(
        volume_radiance(b.description, {{0.3f, 0.2f, -3}, normalize(Vec3f(0.1f, 0.05f, 1))}, 400),
        [](float) { return 1.0; }, "furnace", 1e-4);
    // No density above the bound.
    const SceneTables tables(b.scene);
    const auto sampled = m.at(tables.view(), 0, SampledWavelengths::sample_visible(0.37f));
    TestUniforms uniforms(3);
    for (int i = 0; i < 500; ++i) {
        const Vec2f u = uniforms.next_2f(), v = uniforms.next_2f();
        const Point3f p(2 * u.x - 1, 2 * u.y - 1, 2 * v.x - 1);
        MajorantWalk walk = sampled.majorants({p, {0, 0, 1}, 1e-3f});
        MajorantSegment segment;
        ASSERT_TRUE(walk.next(segment));
        const MediumPoint c = sampled.coefficients(p);
        for (int k = 0; k < 4; ++k) EXPECT_LE(c.sigma_s[k], segment.majorant[k] * 1.0001f);
    }
}

} // namespace
} // namespace montelux::testing
