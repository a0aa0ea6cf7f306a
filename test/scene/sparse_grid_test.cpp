// Sparse grids and their medium, against dense formulas.
#include "test/scene/sparse_grid_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/scene_tables.h"

namespace montelux::testing {
namespace {

// Smooth and spiky values near a sphere across nodes, 0.5 in its middle, and nothing elsewhere.
float blob(int i, int j, int k) {
    const int d = (i - 125) * (i - 125) + (j - 40) * (j - 40) + (k - 130) * (k - 130);
    if (d > 30 * 30) return 0;
    if (d < 20 * 20) return 0.5f;
    const auto hash = static_cast<unsigned>(i) * 73856093u ^ static_cast<unsigned>(j) * 19349663u ^
                      static_cast<unsigned>(k) * 83492791u;
    return static_cast<float>(hash % 97) / 97;
}
SparseGrid blob_grid() { return sparse_grid({2, 1, 2}, blob); }

TEST(SparseGrid, KeepsBlocksOnlyWhereValuesDiffer) {
    const SparseGrid g = blob_grid();
    EXPECT_TRUE(g.is_consistent());
    EXPECT_LT(g.block_count(), 500u); // of 16384
    for (int i = 90; i < 160; ++i)
        for (int j = 0; j < 75; ++j)
            for (int k = 95; k < 165; ++k) ASSERT_EQ(g.value(i, j, k), blob(i, j, k));
    for (const auto [i, j, k] : {std::array{-1, 0, 0}, std::array{256, 0, 0}, std::array{0, 128, 0},
                                 std::array{0, 0, -129}, std::array{1 << 30, -(1 << 30), 0}})
        EXPECT_EQ(g.value(i, j, k), 0);
}

TEST(SparseGrid, InterpolatesBetweenVoxels) {
    const SparseGrid g = blob_grid();
    TestUniforms uniforms(7);
    for (int n = 0; n < 100000; ++n) {
        const Point3f p(90 + 70 * uniforms.next_float(), 5 + 70 * uniforms.next_float(),
                        95 + 70 * uniforms.next_float());
        double expected = 0;
        std::array<int, 3> c{};
        for (int a = 0; a < 3; ++a) c[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(p[a]));
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1;
            std::array<int, 3> v = c;
            for (int a = 0; a < 3; ++a) {
                const auto at = static_cast<std::size_t>(a);
                const double f = double(p[a]) - c[at];
                const bool up = (corner >> a & 1) != 0;
                weight *= up ? f : 1 - f;
                v[at] += up;
            }
            expected += weight * double(blob(v[0], v[1], v[2]));
        }
        ASSERT_NEAR(g(p), expected, 2e-6) << p.x << ' ' << p.y << ' ' << p.z;
    }
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), big = 1e30f;
    for (const Point3f p : {Point3f(nan, nan, nan), Point3f(big, 0, 0), Point3f(0, -big, big)})
        EXPECT_EQ(g(p), 0);
}

TEST(SparseGrid, LargestIsThatOfTheVoxelsInReach) {
    const SparseGrid g = blob_grid();
    TestUniforms uniforms(8);
    for (int n = 0; n < 300; ++n) {
        std::array<int, 3> lower{}, upper{};
        Point3f from, to;
        for (int a = 0; a < 3; ++a) {
            const auto at = static_cast<std::size_t>(a);
            // Away from integers, where rounding must reach further.
            const float least = a == 1 ? -10.0f : 80.0f;
            from[a] = std::floor(least + 90 * uniforms.next_float()) + 0.25f;
            to[a] = from[a] + std::floor(20 * uniforms.next_float()) + 0.5f;
            lower[at] = static_cast<int>(std::floor(from[a]));
            upper[at] = static_cast<int>(std::floor(to[a])) + 1;
        }
        float expected = 0;
        for (int i = lower[0]; i <= upper[0]; ++i)
            for (int j = lower[1]; j <= upper[1]; ++j)
                for (int k = lower[2]; k <= upper[2]; ++k) expected = std::max(expected, blob(i, j, k));
        EXPECT_EQ(g.largest(from, to), expected);
    }
}

TEST(SparseGrid, FindsWhatIsNotZero) {
    const SparseGrid::VoxelRange r = blob_grid().non_zero();
    // The blob reaches its radius along the axes, unless its last value happens to be 0.
    std::array<int, 3> lower{999, 999, 999}, upper{-1, -1, -1};
    for (int i = 90; i < 160; ++i)
        for (int j = 0; j < 75; ++j)
            for (int k = 95; k < 165; ++k)
                if (blob(i, j, k) != 0) {
                    const std::array<int, 3> v{i, j, k};
                    for (std::size_t a = 0; a < 3; ++a) {
                        lower[a] = std::min(lower[a], v[a]);
                        upper[a] = std::max(upper[a], v[a]);
                    }
                }
    EXPECT_EQ(r.lower, lower);
    EXPECT_EQ(r.upper, upper);
    EXPECT_TRUE(SparseGrid().non_zero().empty());
    EXPECT_TRUE(sparse_grid({1, 1, 1}, [](int, int, int) { return 0.0f; }).non_zero().empty());
}

TEST(SparseGrid, TablesThatLeadNowhereAreSeen) {
    const auto broken = [](const auto& change) {
        SparseGrid g = blob_grid();
        change(g);
        return !g.is_consistent();
    };
    EXPECT_TRUE(broken([](SparseGrid& g) { g.nodes[1] = 4; }));
    EXPECT_TRUE(broken([](SparseGrid& g) { g.nodes[0] = SparseGrid::constant_entry | 9; }));
    EXPECT_TRUE(broken([](SparseGrid& g) { g.blocks[5] = static_cast<std::uint32_t>(g.block_count()); }));
    EXPECT_TRUE(broken([](SparseGrid& g) { g.values.pop_back(); }));
    EXPECT_TRUE(broken([](SparseGrid& g) { g.blocks.pop_back(); }));
    EXPECT_TRUE(broken([](SparseGrid& g) { g.node_count[1] = 2; }));
    EXPECT_TRUE(broken([](SparseGrid& g) { g.constants.clear(); }));
}

// Every segment bounds the density on it, and nothing lies beyond the box.
TEST(SparseGridMedium, MajorantsBoundTheDensity) {
    Scene scene;
    scene.sparse_grids.push_back(blob_grid());
    SparseGridMedium m;
    m.density = 0;
    const SparseGrid::VoxelRange range = scene.sparse_grids[0].non_zero();
    for (int a = 0; a < 3; ++a) {
        m.box.p0[a] = static_cast<float>(range.lower[static_cast<std::size_t>(a)] - 1);
        m.box.p1[a] = static_cast<float>(range.upper[static_cast<std::size_t>(a)] + 1);
    }
    m.box.world_from_medium = Transform::translate({50, -20, 7}) * Transform::rotate(40, {1, 2, 3}) *
                              Transform::scale({0.1, 0.07, 0.2});
    m.sigma_a = 0.25f;
    m.sigma_s = 0.75f;
    m.scale = 3;
    scene.media.push_back(m);
    const SceneTables tables(scene);
    const auto local = m.at(tables.view(), 0, SampledWavelengths::sample_visible(0.5f));
    TestUniforms uniforms(9);
    double passed = 0, empty = 0;
    for (int n = 0; n < 3000; ++n) {
        const Point3f voxel(90 + 70 * uniforms.next_float(), 5 + 70 * uniforms.next_float(),
                            95 + 70 * uniforms.next_float());
        const Point3f target = m.box.world_from_medium.point(voxel);
        const Vec3f d = normalize(Vec3f(uniforms.next_float(), uniforms.next_float(), uniforms.next_float()) -
                                  Vec3f(0.5f, 0.5f, 0.5f));
        EXPECT_NEAR(local.coefficients(target).sigma_s[0], 3 * 0.75f * scene.sparse_grids[0](voxel), 3e-3f);
        const Ray ray{target - d * 15, d};
        MajorantWalk walk = local.majorants(ray);
        MajorantSegment s;
        while (walk.next(s)) {
            (s.majorant[0] > 0 ? passed : empty) += double(s.t1 - s.t0);
            for (int k = 0; k < 4; ++k) {
                const float t = s.t0 + (s.t1 - s.t0) * uniforms.next_float();
                const MediumPoint p = local.coefficients(ray.o + ray.d * t);
                ASSERT_LE((p.sigma_a + p.sigma_s)[0], s.majorant[0] * 1.0001f + 1e-6f);
            }
        }
    }
    EXPECT_GT(passed, 3000);
    EXPECT_GT(empty, 1000);
}

} // namespace
} // namespace montelux::testing
