#include "test/bake/bake_testing.h"
#include <array>
#include <set>
#include <vector>

#include "montelux/bake/area_estimate.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

// Mean over a texel of the cube by the midpoint rule, weighted by solid angle.
Vec3d mean_over(const EnvironmentMap& map, const CubeTexel& t, int size, int points) {
    Vec3d sum;
    double weights = 0;
    for (int j = 0; j < points; ++j)
        for (int i = 0; i < points; ++i) {
            const double u = (t.x + (i + 0.5) / points) / size, v = (t.y + (j + 0.5) / points) / size;
            const double a = 2 * u - 1, b = 2 * v - 1, r2 = 1 + a * a + b * b,
                         weight = 1 / (r2 * std::sqrt(r2));
            const Vec3d d = CubeFrame{}.to_map(cube_direction({t.face, u, v}));
            sum += Vec3d(map.radiance(Vec3f(d))) * weight;
            weights += weight;
        }
    return sum / weights;
}

// Texels of the cube that a lamp, a sun or noise of the map crosses: truth within two of the errors claimed
// as often as it should be, or more often, and the targets met. Six seeds of some hundred texels; the shares
// have an error below 0.01.
void expect_honest(const Image& image, int size, const std::vector<double>& targets) {
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    AreaEstimator areas(map, CubeFrame{});
    struct Counts {
        int runs = 0, within_two = 0, within_four = 0;
        double squares = 0;
    };
    std::vector<Counts> of_target(targets.size());
    for (int face = 0; face < cube_faces; ++face)
        for (int y = 0; y < size; y += 4)
            for (int x = face % 4; x < size; x += 3) {
                const CubeTexel texel{face, x, y};
                const Vec3d truth = mean_over(map, texel, size, 300);
                for (std::size_t k = 0; k < targets.size(); ++k)
                    for (std::uint64_t seed = 0; seed < 6; ++seed) {
                        TexelTarget target;
                        target.target_error = targets[k];
                        target.floor = 0.01 * map.mean_radiance().y;
                        const TexelEstimate e = areas.estimate(
                            texel, size, target, hash_key(seed, static_cast<std::uint64_t>(face), x, y));
                        EXPECT_TRUE(e.met);
                        if (e.standard_error.y == 0) {
                            EXPECT_NEAR(e.value.y, truth.y, 1e-5 * truth.y);
                            continue;
                        }
                        // The rule has an error of its own.
                        const double error = std::hypot(e.standard_error.y, 0.05 * targets[k] * truth.y);
                        const double z = std::abs(e.value.y - truth.y) / error;
                        Counts& c = of_target[k];
                        ++c.runs;
                        c.within_two += z < 2;
                        c.within_four += z < 4;
                        c.squares += z * z;
                    }
            }
    for (const Counts& c : of_target) {
        ASSERT_GT(c.runs, 100);
        EXPECT_GT(c.within_two, 0.93 * c.runs);
        EXPECT_GT(c.within_four, 0.99 * c.runs);
        EXPECT_LT(c.squares, 1.3 * c.runs);
        EXPECT_GT(c.squares, 0.3 * c.runs);
    }
}

TEST(AreaEstimator, HonestWhereEdgesCrossTexels) {
    Image lamp(48, 24, {"R", "G", "B"});
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 48; ++x)
            for (int c = 0; c < 3; ++c)
                lamp.set(x, y, c, x > 10 && x < 30 && y > 5 && y < 9 ? 90.0f : 1.0f + 0.2f * y);
    expect_honest(lamp, 16, {0.01, 0.003});
}
TEST(AreaEstimator, HonestOnNoise) { expect_honest(random_map(40, 20, 3e3f), 12, {0.01}); }
// More texels of the map than parts at first.
TEST(AreaEstimator, HonestOnMapsThatAreFinerThanTheCube) {
    expect_honest(random_map(128, 64, 1e5f), 8, {0.02});
}

// A lamp that falls between the corners of a few parts: its texel has not met the target in so few samples,
// or has found the lamp.
TEST(AreaEstimator, LampsThatFewPartsCanMissAreNotForgotten) {
    for (auto [width, height] : {std::pair(1024, 512), {512, 512}}) {
        const EnvironmentLayout layout = *layout_of_size(width, height);
        // On the pole and an edge of the octahedron, and elsewhere; each in a texel
        // of the cube of its own.
        const Vec2f places[] = {{101, 2}, {300, 200}, {260, 256}, {3, 90}, {400, 507}, {256, 300}};
        Image lamps(width, height, {"R", "G", "B"});
        for (const Vec2f place : places)
            for (int y = 0; y < 3; ++y)
                for (int x = 0; x < 3; ++x)
                    for (int c = 0; c < 3; ++c)
                        lamps.set(static_cast<int>(place.x) - 1 + x, static_cast<int>(place.y) - 1 + y, c,
                                  1e4f);
        const EnvironmentMap map(lamps, layout);
        AreaEstimator areas(map, CubeFrame{});
        std::set<std::array<int, 3>> texels;
        for (const Vec2f place : places) {
            const CubePoint at =
                cube_point(CubeFrame{}.from_map(Vec3d(map.grid().direction(place + Vec2f{0.5f, 0.5f}))));
            constexpr int size = 8;
            const CubeTexel texel{at.face, static_cast<int>(at.u * size), static_cast<int>(at.v * size)};
            EXPECT_TRUE(texels.insert({texel.face, texel.x, texel.y}).second);
            TexelTarget target;
            target.floor = 0.01 * map.mean_radiance().y / std::size(places);
            target.samples = 64;
            EXPECT_FALSE(areas.estimate(texel, size, target, 5).met)
                << width << " " << place.x << " " << place.y;
            target.samples = 1 << 20;
            const TexelEstimate e = areas.estimate(texel, size, target, 5);
            EXPECT_TRUE(e.met);
            EXPECT_GT(e.value.y, 0) << width << " " << place.x << " " << place.y;
        }
    }
}

} // namespace
} // namespace montelux
