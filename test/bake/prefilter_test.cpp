#include "test/bake/bake_testing.h"
#include <limits>
#include <string>

#include "montelux/bake/prefilter.h"
#include "montelux/bake/texel_estimate.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

// D(h) n.l with the half vector itself, and normalised by the sum, not by a formula.
Vec3d reflected(const TexelPoints& points, Vec3d n, double roughness) {
    const double alpha2 = std::pow(roughness, 4);
    auto weight = [&](Vec3d l) {
        const double n_dot_l = dot(n, l);
        if (n_dot_l <= 0) return 0.0;
        const Vec3d h = normalize(n + l);
        const double t = dot(n, h) * dot(n, h) * (alpha2 - 1) + 1;
        return alpha2 / (pi * t * t) * n_dot_l;
    };
    double total = 0;
    const Vec3d sum = points.sum(weight, &total);
    return sum / total;
}

Vec3d texel_of(const CubeMap& map, const CubeTexel& t) {
    const Image& face = map.faces[static_cast<std::size_t>(t.face)];
    return {face.value(t.x, t.y, 0), face.value(t.x, t.y, 1), face.value(t.x, t.y, 2)};
}

struct Scores {
    int texels = 0, outside = 0; // by more than three standard errors
    double sum = 0, squares = 0;

    void add(double z) {
        ++texels;
        outside += std::abs(z) > 3;
        sum += z;
        squares += z * z;
    }
    double mean() const { return sum / texels; }
    double deviation() const { return std::sqrt(squares / texels); }
};

// Scores of the green channel against quadrature; green has a say in how cells are sampled, but not the only
// one.
Scores scores_of(const Image& image, const std::vector<BakedCubes>& baked, int parts) {
    Scores scores;
    const TexelPoints points(image, parts);
    for (std::size_t level = 0; level < baked[0].levels.size(); ++level) {
        const auto [size, roughness] =
            std::pair{baked[0].levels[level].size, baked[0].levels[level].roughness};
        for (int face = 0; face < cube_faces; ++face)
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    const CubeTexel t{face, x, y};
                    const Vec3d expected = reflected(points, cube_texel_direction(t, size), roughness);
                    for (const BakedCubes& b : baked) {
                        const double error = texel_of(b.standard_error.levels[level], t).y;
                        scores.add((texel_of(b.value.levels[level], t).y - expected.y) / error);
                    }
                }
    }
    return scores;
}

// With 6 (64 + 16 + 4) = 504 texels: more than 12 outside happens to normal scores with probability 1e-8, the
// mean leaves five of its errors with 6e-7, the deviation (which has an error of 0.03) its bounds with less.
void expect_calibrated(const Scores& s) {
    EXPECT_LE(s.outside, 12) << "of " << s.texels;
    EXPECT_LT(std::abs(s.mean()), 5 / std::sqrt(s.texels));
    EXPECT_GT(s.deviation(), 0.8);
    EXPECT_LT(s.deviation(), 1.2);
}

TEST(Prefilter, CalibratedAgainstQuadratureByCells) {
    const Image image = random_map(16, 8, 1e4f);
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    BakeSettings settings;
    settings.target_error = 0.02;
    const BakedCubes baked = prefilter_environment(map, 8, {0.4, 0.6, 1.0}, settings);
    const Scores scores = scores_of(image, {baked}, 16);
    expect_calibrated(scores);
    for (const LevelReport& level : baked.levels) {
        EXPECT_EQ(level.missed, 0u);
        EXPECT_LE(level.largest_error, 0.02);
    }
}

TEST(Prefilter, CalibratedAgainstQuadratureByLobes) {
    const Image image = random_map(16, 8);
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    BakeSettings settings;
    settings.sampling = PrefilterSampling::lobe;
    settings.target_error = 0.02;
    const BakedCubes baked = prefilter_environment(map, 8, {0.4, 0.6, 1.0}, settings);
    expect_calibrated(scores_of(image, {baked}, 16));
}

TEST(Prefilter, CalibratedWithFixedSamples) {
    const Image image = random_map(16, 8, 1e3f);
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    BakeSettings settings;
    settings.target_error.reset();
    settings.samples = 400;
    const BakedCubes baked = prefilter_environment(map, 8, {0.4, 0.6, 1.0}, settings);
    expect_calibrated(scores_of(image, {baked}, 16));
    for (const LevelReport& level : baked.levels) {
        const double samples = static_cast<double>(level.samples) / (6.0 * level.size * level.size);
        EXPECT_LE(samples, 400);
        EXPECT_GT(samples, 150);
    }
}

// An equal-area map of a sky that is bright above z = 0 of its frame, up in the cube: radiance 1 above the
// horizon.
TEST(Prefilter, IrradianceOfHalfASky) {
    Image image(64, 64, {"Y"});
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            if (std::abs(2 * (x + 0.5) / 64 - 1) + std::abs(2 * (y + 0.5) / 64 - 1) < 1)
                image.set(x, y, 0, 1);
    const EnvironmentMap map(image, EnvironmentLayout::equal_area);
    BakeSettings settings;
    const BakedCubes baked = irradiance_cube(map, 4, settings);
    for (int face = 0; face < cube_faces; ++face)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                const CubeTexel t{face, x, y};
                // E / pi of the upper half of a sphere; its edge runs through texels of the map.
                const double expected = (1 + cube_texel_direction(t, 4).y) / 2;
                EXPECT_NEAR(texel_of(baked.value.levels[0], t).x, expected, 0.02 + 0.06 * expected);
            }
    EXPECT_EQ(baked.levels[0].missed, 0u);
}

TEST(Prefilter, ConstantAndBlackMapsKeepTheirValue) {
    for (float light : {0.0f, 3.0f, 1e36f}) {
        Image image(3, 2, {"Y"});
        for (float& v : image.f32()) v = light;
        const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
        BakeSettings settings;
        for (PrefilterSampling sampling : {PrefilterSampling::cells, PrefilterSampling::lobe}) {
            settings.sampling = sampling;
            const BakedCubes baked = prefilter_environment(map, 4, {0, 0.3, 1}, settings);
            for (std::size_t level = 0; level < 3; ++level)
                for (const Image& face : baked.value.levels[level].faces)
                    for (float v : face.f32())
                        EXPECT_NEAR(v, light, 0.04 * static_cast<double>(light)) << level;
            EXPECT_EQ(baked.levels[0].missed + baked.levels[1].missed + baked.levels[2].missed, 0u);
        }
    }
}

// One texel of a 1 x 1 map, a needle of a lobe, a sun of 1e30 beside darkness.
TEST(Prefilter, OddMapsAndNarrowLobesEnd) {
    BakeSettings settings;
    const EnvironmentMap one(random_map(1, 1), EnvironmentLayout::equirectangular);
    EXPECT_EQ(prefilter_environment(one, 2, {0.01, 1}, settings).levels[0].missed, 0u);
    Image sun(64, 32, {"Y"});
    sun.set(20, 10, 0, 1e30f);
    const EnvironmentMap map(sun, EnvironmentLayout::equirectangular);
    for (const LevelReport& level : prefilter_environment(map, 8, {0, 0.02, 0.2, 1}, settings).levels)
        EXPECT_LE(level.largest_error, 0.01) << level.roughness;
}

TEST(Prefilter, MeansOfTexelsKeepTheEnergy) {
    const Image image = random_map(64, 32, 100);
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    BakeSettings settings;
    const BakedCubes baked = prefilter_environment(map, 8, {0.0}, settings);
    Vec3d sum;
    double variance = 0;
    for (int face = 0; face < cube_faces; ++face)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                const double omega = cube_texel_solid_angle(x, y, 8) / (4 * pi);
                sum += texel_of(baked.value.levels[0], {face, x, y}) * omega;
                const double e = texel_of(baked.standard_error.levels[0], {face, x, y}).y * omega;
                variance += e * e;
            }
    // Five standard errors: a false alarm in 2 million.
    EXPECT_NEAR(sum.y, map.mean_radiance().y, 5 * std::sqrt(variance));
}

TEST(Prefilter, SameBitsOnAnyNumberOfThreads) {
    const EnvironmentMap map(random_map(32, 16, 1e4f), EnvironmentLayout::equirectangular);
    BakeSettings settings;
    settings.target_error = 0.03;
    double progress = 0;
    settings.progress = [&](double fraction) { progress = fraction; };
    const BakedCubes first = prefilter_environment(map, 8, {0, 0.4, 1}, settings);
    EXPECT_EQ(progress, 1);
    for (int threads : {1, 3}) {
        const BakedCubes again = with_threads(threads, [&] {
            return prefilter_environment(map, 8, {0, 0.4, 1}, settings);
        });
        for (std::size_t level = 0; level < 3; ++level) {
            EXPECT_EQ(again.levels[level].samples, first.levels[level].samples);
            EXPECT_EQ(again.levels[level].mean_error, first.levels[level].mean_error);
            for (std::size_t face = 0; face < cube_faces; ++face)
                EXPECT_TRUE(std::ranges::equal(again.value.levels[level].faces[face].f32(),
                                               first.value.levels[level].faces[face].f32()));
        }
    }
    settings.seed = 1;
    const BakedCubes other = prefilter_environment(map, 8, {0, 0.4, 1}, settings);
    EXPECT_FALSE(
        std::ranges::equal(other.value.levels[1].faces[0].f32(), first.value.levels[1].faces[0].f32()));
    CancelFlag cancel;
    cancel.request();
    settings.cancel = &cancel;
    EXPECT_TRUE(prefilter_environment(map, 8, {0, 0.4, 1}, settings).cancelled);
}

TEST(Prefilter, SourceMipsAreNearAndReportTheirSamples) {
    const Image image = random_map(64, 32, 100);
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    BakeSettings settings;
    settings.target_error.reset();
    settings.samples = 512;
    const BakedCubes exact = prefilter_environment(map, 4, {0.7}, settings);
    settings.sampling = PrefilterSampling::lobe;
    const BakedCubes plain = prefilter_environment(map, 4, {0.7}, settings);
    settings.source_mips = true;
    const BakedCubes filtered = prefilter_environment(map, 4, {0.7}, settings);
    EXPECT_LT(filtered.levels[0].mean_error, 0.7 * plain.levels[0].mean_error);
    EXPECT_LT(exact.levels[0].mean_error, 0.5 * plain.levels[0].mean_error);
    for (int face = 0; face < cube_faces; ++face) {
        const double truth = texel_of(exact.value.levels[0], {face, 1, 2}).y;
        EXPECT_NEAR(texel_of(filtered.value.levels[0], {face, 1, 2}).y, truth, 0.25 * truth);
    }
}

TEST(Prefilter, MissedTargetsAreCounted) {
    const EnvironmentMap map(random_map(64, 32), EnvironmentLayout::equirectangular);
    BakeSettings settings;
    settings.target_error = 1e-4;
    settings.samples = 64;
    const BakedCubes baked = prefilter_environment(map, 2, {0.5}, settings);
    EXPECT_EQ(baked.levels[0].missed, 24u);
    EXPECT_LE(baked.levels[0].samples, 24u * 200);
    settings.target_error = 0;
    EXPECT_THROW(prefilter_environment(map, 2, {0.5}, settings), Error);
    settings.target_error = 0.01;
    EXPECT_THROW(prefilter_environment(map, 2, {0.5, 0.6, 0.7}, settings), Error);
    EXPECT_THROW(prefilter_environment(map, 2, {1.5}, settings), Error);
    EXPECT_THROW(prefilter_environment(map, 0, {0.5}, settings), Error);
}

// Half of the map is a thousandth as bright as the other. Texels that face it must meet the target relative to their
// own brightness.
TEST(Prefilter, DarkTexelsMeetTheirOwnTarget) {
    Image image = random_map(64, 32);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width() / 2; ++x)
            for (int c = 0; c < 3; ++c) image.set(x, y, c, 1e-3f * image.value(x, y, c));
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    BakeSettings settings;
    settings.target_error = 0.02;
    settings.dark_floor = 1e-4;
    const BakedCubes baked = prefilter_environment(map, 4, {0.2}, settings);
    int dark = 0;
    for (int face = 0; face < cube_faces; ++face)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                const Vec3d value = texel_of(baked.value.levels[0], {face, x, y}),
                            error = texel_of(baked.standard_error.levels[0], {face, x, y});
                const double mean = (value.x + value.y + value.z) / 3;
                dark += mean < 0.1;
                EXPECT_LE(std::max({error.x, error.y, error.z}), 1.01 * 0.02 * mean)
                    << face << " " << x << " " << y;
            }
    EXPECT_GT(dark, 20);
}

TEST(Prefilter, TexelsThatAreNotFiniteAreMissed) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(meets({{1, nan, 1}, {0, 0, 0}}, {}));
    EXPECT_FALSE(meets({{1, 1, 1}, {0, nan, 0}}, {}));
    EXPECT_TRUE(meets({{1, 1, 1}, {0, 0, 0}}, {}));
    EXPECT_FALSE(std::isfinite(missed_by({{1, 1, nan}, {0, 0, 0}}, {}, 1)));
}

TEST(Prefilter, RoughnessOfLevels) {
    using enum RoughnessRule;
    EXPECT_EQ(roughness_by_rule(linear, 5, 256), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
    EXPECT_EQ(roughness_by_rule(linear, 1, 256), (std::vector<double>{0}));
    const std::vector<double> r = roughness_by_rule(filament, 5, 256);
    for (int level = 0; level < 5; ++level) EXPECT_NEAR(4 * r[level] * (2 - r[level]), level, 1e-12);
    const std::vector<double> b = roughness_by_rule(babylon, 9, 256);
    EXPECT_EQ(b[0], 0);
    for (int level = 1; level < 7; ++level)
        EXPECT_NEAR(0.8 * std::log2(256 * b[level] * b[level]), level, 1e-12);
    EXPECT_EQ(b[7], 1);
    EXPECT_EQ(b[8], 1);
    EXPECT_EQ(roughness_by_rule(linear, {}, 256).size(), 5u);
    EXPECT_EQ(roughness_by_rule(filament, {}, 8).size(), 1u);
    EXPECT_EQ(roughness_by_rule(babylon, {}, 256), b);
    EXPECT_THROW(roughness_by_rule(linear, 0, 256), Error);
    EXPECT_THROW(roughness_by_rule(linear, 10, 256), Error);
    EXPECT_THROW(roughness_by_rule(linear, {}, 0), Error);
}

// The definition of done: 99.5 % of the texels within three of their standard errors. 0.27 % are outside by
// chance; with 6 * 85 * 64 texels and more, 0.5 % are beyond any.
TEST(PrefilterSlowTest, TexelsAreWithinThreeErrorsOfQuadrature) {
    const Image image = random_map(32, 16, 1e4f);
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    std::vector<BakedCubes> baked;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        BakeSettings settings;
        settings.seed = seed;
        baked.push_back(prefilter_environment(map, 32, {0.35, 0.5, 0.75, 1.0}, settings));
    }
    const Scores all = scores_of(image, baked, 12);
    EXPECT_LT(all.outside, 0.005 * all.texels);
    EXPECT_LT(std::abs(all.mean()), 5 / std::sqrt(all.texels));
    RecordProperty("texels", all.texels);
    RecordProperty("outside", all.outside);
    RecordProperty("mean", std::to_string(all.mean()));
    RecordProperty("deviation", std::to_string(all.deviation()));
}

} // namespace
} // namespace montelux
