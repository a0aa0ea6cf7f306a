#include "test/bake/bake_testing.h"
#include "test/near.h"
#include <limits>

#include "montelux/bake/cube_frame.h"
#include "montelux/bake/spherical_harmonics.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/warp/sphere.h"

namespace montelux {
namespace {

TEST(CubeFrame, PutsTheMapWhereItsCommentsSay) {
    const Image image = random_map(32, 16);
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    auto texel = [&](int x, int y) {
        return Vec3d{image.value(x, y, 0), image.value(x, y, 1), image.value(x, y, 2)};
    };
    auto seen = [&](const CubeFrame& frame, Vec3d cube) {
        return Vec3d(map.radiance(Vec3f(frame.to_map(normalize(cube)))));
    };
    // A little right of and above the middle, and what lies a quarter turn to its right.
    const Vec3d front = texel(16, 7), right = texel(24, 7), top = texel(16, 0);
    const double e = 0.02;
    expect_near(seen({}, {e, e, 1}), front, 1e-4);
    expect_near(seen({}, {1, e, -e}), right, 1e-4);
    expect_near(seen({}, {e * 0.01, 1, e}), top, 1e-4);
    expect_near(seen({true}, {1, e, e}), front, 1e-4);
    expect_near(seen({true}, {-e, 1, e}), right, 1e-4);
    expect_near(seen({true}, {e, e * 0.01, 1}), top, 1e-4);
    expect_near(seen({false, true}, {-e, e, 1}), front, 1e-4);
    expect_near(seen({false, true}, {-1, e, -e}), right, 1e-4);
    expect_near(seen({false, false, 90}, {e, e, 1}), right, 1e-4);
    for (const CubeFrame& frame : {CubeFrame{}, CubeFrame{true}, CubeFrame{true, true, 30}}) {
        const Vec3d d = normalize(Vec3d{0.3, -0.5, 0.7});
        expect_near(frame.from_map(frame.to_map(d)), d, 1e-14);
    }
}

TEST(EnvironmentMap, BlocksHoldTheEnergyOfTheirTexels) {
    for (auto [width, height] : {std::pair{1, 1}, {2, 1}, {7, 5}, {16, 8}, {33, 17}}) {
        const Image image = random_map(width, height, 1e30f);
        const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
        // Solid angles by the cosines of the colatitudes.
        Vec3d sum;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const double omega =
                    2 * pi / width * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
                EXPECT_NEAR(map.solid_angle({0, x, y}), omega, 1e-12);
                sum += Vec3d{image.value(x, y, 0), image.value(x, y, 1), image.value(x, y, 2)} * omega;
            }
        const Vec3d mean = map.mean_radiance();
        EXPECT_NEAR(mean.x / (sum.x / (4 * pi)), 1, 1e-5) << width << " x " << height;
        EXPECT_NEAR(mean.z / (sum.z / (4 * pi)), 1, 1e-5);
        EXPECT_NEAR(map.solid_angle({map.top_level(), 0, 0}), 4 * pi, 1e-12);
        const Vec3d coarse(map.radiance({0, 0, 1}, map.top_level()));
        EXPECT_NEAR(coarse.y / mean.y, 1, 1e-5);
    }
}

// Sums stay finite up to the largest radiance, also over the small texels at the poles of a fine map.
TEST(EnvironmentMap, LargeValuesAreFiniteOrRefused) {
    Image image = random_map(8, 4096);
    for (int y : {0, 2000, 4095})
        for (int c = 0; c < 3; ++c) image.set(1, y, c, EnvironmentMap::largest_radiance);
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    for (int y : {0, 2000, 4095}) {
        const Vec3f l = map.radiance(MapCell{0, 1, y});
        EXPECT_NEAR(static_cast<double>(l.x / image.value(1, y, 0)), 1, 1e-5) << y;
    }
    EXPECT_TRUE(std::isfinite(map.mean_radiance().y));
    image.set(3, 2, 1, 3e38f);
    EXPECT_THROW(EnvironmentMap(image, EnvironmentLayout::equirectangular), Error);
}

// Balls hold their cells, directions come back to their texels, for both layouts and parts of texels too.
TEST(EnvironmentMap, BallsHoldTheirCells) {
    for (EnvironmentLayout layout : {EnvironmentLayout::equirectangular, EnvironmentLayout::equal_area}) {
        const Image image = layout == EnvironmentLayout::equal_area ? random_map(20, 20) : random_map(37, 19);
        const EnvironmentMap map(image, layout);
        PhiloxStream stream(3);
        for (int i = 0; i < 20000; ++i) {
            const int x = static_cast<int>(stream.next_1d() * static_cast<float>(map.grid().width()));
            const int y = static_cast<int>(stream.next_1d() * static_cast<float>(map.grid().height()));
            const Vec2f within = stream.next_2d();
            const Vec3f d = map.direction({0, x, y}, within.x, within.y);
            for (int level = -3; level <= map.top_level(); ++level) {
                MapCell cell{level, x >> std::max(level, 0), y >> std::max(level, 0)};
                if (level < 0) {
                    const auto parts = static_cast<float>(1 << -level);
                    cell.x = static_cast<int>((static_cast<float>(x) + within.x) * parts);
                    cell.y = static_cast<int>((static_cast<float>(y) + within.y) * parts);
                }
                const EnvironmentMap::Ball ball = map.ball(cell);
                ASSERT_LE(length(d - ball.centre), ball.radius + 1e-5f) << level << ": " << x << ", " << y;
            }
            if (std::abs(within.x - 0.5f) < 0.49f && std::abs(within.y - 0.5f) < 0.49f) {
                ASSERT_EQ(map.radiance(d).x, map.radiance(map.direction({0, x, y}, 0.5f, 0.5f)).x);
            }
        }
    }
}

// Texels are drawn as often as their energies say; p below 1e-8 for each of 32 counts to miss by six
// deviations.
TEST(EnvironmentMap, DrawsFollowTheEnergy) {
    const EnvironmentMap map(random_map(8, 4), EnvironmentLayout::equirectangular);
    const MapCell whole{map.top_level(), 0, 0};
    constexpr int draws = 100000;
    std::array<int, 32> counts{};
    for (int i = 0; i < draws; ++i) {
        const MapCell texel = map.draw_texel(whole, (i + 0.5) / draws);
        ++counts[static_cast<std::size_t>(8 * texel.y + texel.x)];
    }
    double integral = 0;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) {
            const double p =
                static_cast<double>(map.energy_sum({0, x, y})) / static_cast<double>(map.energy_sum(whole));
            EXPECT_NEAR(counts[static_cast<std::size_t>(8 * y + x)], draws * p, 2.0);
            const double density = map.density(map.direction({0, x, y}, 0.3f, 0.6f));
            EXPECT_NEAR(density * map.solid_angle({0, x, y}), p, 1e-6);
            integral += p;
        }
    EXPECT_NEAR(integral, 1, 1e-6);
}

TEST(EnvironmentMap, RepairsAndRefuses) {
    Image image(4, 2, {"R", "G", "B"});
    for (float& v : image.f32()) v = 1;
    image.set(0, 0, 0, -1);
    image.set(1, 0, 1, std::numeric_limits<float>::quiet_NaN());
    image.set(2, 0, 2, std::numeric_limits<float>::infinity());
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    EXPECT_EQ(map.repairs().negative, 1u);
    EXPECT_EQ(map.repairs().nan, 1u);
    EXPECT_EQ(map.repairs().infinite, 1u);
    EXPECT_LT(map.mean_radiance().x, 1);
    EXPECT_THROW(EnvironmentMap(image, EnvironmentLayout::equal_area), Error);
    EXPECT_THROW(EnvironmentMap(Image(2, 1, {"Z"}), EnvironmentLayout::equirectangular), Error);
    Image grey(2, 1, {"Y"});
    grey.set(0, 0, 0, 2);
    expect_near(EnvironmentMap(grey, EnvironmentLayout::equirectangular).mean_radiance(), {1, 1, 1}, 1e-6);
    const EnvironmentMap black(Image(2, 1, {"R", "G", "B"}), EnvironmentLayout::equirectangular);
    EXPECT_EQ(black.mean_radiance(), Vec3d{});
    EXPECT_EQ(black.density({0, 0, 1}), 0);
}

TEST(DiffuseHarmonics, AgreeWithQuadrature) {
    for (auto [width, height] : {std::pair{16, 8}, {5, 3}}) {
        const Image image = random_map(width, height, 1e3f);
        const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
        const DiffuseHarmonics h = diffuse_harmonics(map, {});
        const double mean = map.mean_radiance().x;
        for (std::size_t i = 0; i < sh_terms; ++i) {
            // The functions as three.js writes them.
            auto y = [&](Vec3d d) {
                const double v[] = {0.282095,
                                    0.488603 * d.y,
                                    0.488603 * d.z,
                                    0.488603 * d.x,
                                    1.092548 * d.x * d.y,
                                    1.092548 * d.y * d.z,
                                    0.315392 * (3 * d.z * d.z - 1),
                                    1.092548 * d.x * d.z,
                                    0.546274 * (d.x * d.x - d.y * d.y)};
                return v[i];
            };
            const Vec3d expected = TexelPoints(image, 40).sum(y);
            EXPECT_NEAR(h.radiance[i].x, expected.x, 1e-3 * mean) << i;
            EXPECT_NEAR(h.radiance[i].z, expected.z, 1e-3 * mean) << i;
        }
    }
}

TEST(DiffuseHarmonics, GiveTheIrradianceOfOrderTwo) {
    // Light whose radiance has order 2 at most: 3 + d.z + d.x d.y. A cosine lobe scales the orders by pi, 2
    // pi / 3, pi / 4.
    const int width = 128, height = 64;
    Image image(width, height, {"Y"});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3d d = equirectangular_direction((x + 0.5) / width, (y + 0.5) / height);
            image.set(x, y, 0, static_cast<float>(3 + d.z + d.x * d.y));
        }
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    const DiffuseHarmonics h = diffuse_harmonics(map, {});
    PhiloxStream stream(1);
    for (int i = 0; i < 10; ++i) {
        const Vec2f u = stream.next_2d();
        const Vec3d n(sample_uniform_sphere(u));
        const double expected = 3 * pi + 2 * pi / 3 * n.z + pi / 4 * n.x * n.y;
        EXPECT_NEAR(h.irradiance_at(n).y, expected, 5e-3);
        const auto& c = h.polynomial;
        const double polynomial = c[0].x + c[1].x * n.y + c[2].x * n.z + c[3].x * n.x + c[4].x * n.x * n.y +
                                  c[5].x * n.y * n.z + c[6].x * (3 * n.z * n.z - 1) + c[7].x * n.z * n.x +
                                  c[8].x * (n.x * n.x - n.y * n.y);
        EXPECT_NEAR(pi * polynomial, h.irradiance_at(n).x, 1e-9);
    }
}

} // namespace
} // namespace montelux
