#include "test/bake/bake_testing.h"
#include <limits>
#include <string>

#include "montelux/bake/prefilter.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// D(h) n.l with the half vector itself, and normalised by the sum, not by a formula.
Vec3d reflected(const Image& image, Vec3d n, double roughness, int parts) {
    const double alpha2 = std::pow(roughness, 4);
    auto weight = [&](Vec3d l) {
        const double n_dot_l = dot(n, l);
        if (n_dot_l <= 0) return 0.0;
        const Vec3d h = normalize(n + l);
        const double t = dot(n, h) * dot(n, h) * (alpha2 - 1) + 1;
        return alpha2 / (pi * t * t) * n_dot_l;
    };
    double total = 0;
    const Vec3d sum = sum_over_texels(image, parts, [&](Vec3d l) { return weight(l); });
    Image white(image.width(), image.height(), {"R", "G", "B"});
    for (float& v : white.f32()) v = 1;
    total = sum_over_texels(white, parts, weight).x;
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
Scores scores_of(const Image& image, const BakedCubes& baked, int parts) {
    Scores scores;
    for (std::size_t level = 0; level < baked.levels.size(); ++level) {
        const int size = baked.levels[level].size;
        for (int face = 0; face < cube_faces; ++face)
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    const CubeTexel t{face, x, y};
                    const Vec3d expected =
                        reflected(image, cube_texel_direction(t, size), baked.levels[level].roughness, parts);
                    const double error = texel_of(baked.standard_error.levels[level], t).y;
                    scores.add((texel_of(baked.value.levels[level], t).y - expected.y) / error);
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
    const EnvironmentMap map(image, MapLayout::equirectangular);
    BakeSettings settings;
    settings.target_error = 0.02;
    const BakedCubes baked = prefilter_environment(map, 8, {0.4, 0.6, 1.0}, settings);
    const Scores scores = scores_of(image, baked, 16);
    expect_calibrated(scores);
    for (const LevelReport& level : baked.levels) {
        EXPECT_EQ(level.missed, 0u);
        EXPECT_LE(level.largest_error, 0.02);
    }
}

TEST(Prefilter, CalibratedAgainstQuadratureByLobes) {
    const Image image = random_map(16, 8);
    const EnvironmentMap map(image, MapLayout::equirectangular);
    BakeSettings settings;
    settings.sampling = PrefilterSampling::lobe;
    settings.target_error = 0.02;
    const BakedCubes baked = prefilter_environment(map, 8, {0.4, 0.6, 1.0}, settings);
    expect_calibrated(scores_of(image, baked, 16));
}

// The definition of done: 99.5 % of the texels within three of their standard errors. 0.27 % are outside by
// chance; with 6 * 85 * 64 texels and more, 0.5 % are beyond any.
TEST(PrefilterSlowTest, TexelsAreWithinThreeErrorsOfQuadrature) {
    const Image image = random_map(32, 16, 1e4f);
    const EnvironmentMap map(image, MapLayout::equirectangular);
    BakeSettings settings;
    Scores all;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        settings.seed = seed;
        const BakedCubes baked = prefilter_environment(map, 32, {0.35, 0.5, 0.75, 1.0}, settings);
        const Scores s = scores_of(image, baked, 12);
        all.texels += s.texels;
        all.outside += s.outside;
        all.sum += s.sum;
        all.squares += s.squares;
    }
    EXPECT_LT(all.outside, 0.005 * all.texels);
    EXPECT_LT(std::abs(all.mean()), 5 / std::sqrt(all.texels));
    RecordProperty("texels", all.texels);
    RecordProperty("outside", all.outside);
    RecordProperty("mean", std::to_string(all.mean()));
    RecordProperty("deviation", std::to_string(all.deviation()));
}

} // namespace
} // namespace montelux
