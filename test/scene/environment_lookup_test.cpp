// Environment maps that are looked up bilinearly: the blend is continuous on the sphere, and each way to
// sample it follows its density and leaves nothing out. 8 chi-squared tests at 1e-9 each and 36 means at 6.5
// standard errors (8e-11): below 1e-7 for the file.
#include "test/scene/environment_testing.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/light/environment/environment_sampler.h"

namespace montelux::environment_lookup {
namespace {

constexpr Vec3f grey{1, 1, 1};

double blended(const Image& map, const EnvironmentGrid& grid, Vec2f place) {
    const EnvironmentGrid::Blend b = grid.blend(place);
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k)
        sum += static_cast<double>(b.share[k]) * static_cast<double>(map.value_at(3 * b.texel[k]));
    return sum;
}

Image rough_map(int width, int height) {
    return map_of(
        width, height, [](int x, int y) { return (x * 7 + y * 13) % 11 + (x == 3 && y == 0 ? 40 : 0); },
        grey);
}

TEST(EnvironmentLookup, CentresAreTexelsAndBlendsAreContinuous) {
    for (EnvironmentLayout layout : environment_layouts)
        for (auto [width, height] : {std::pair(1, 1), {2, 1}, {8, 8}, {32, 16}}) {
            const EnvironmentGrid grid(layout, width, height);
            const Image map = rough_map(width, height);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    EXPECT_EQ(
                        blended(map, grid, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}),
                        static_cast<double>(map.value(x, y, 0)));
            if (height < 8) continue;
            // Neighbours on the sphere, wherever they lie on the map: along the seams as elsewhere.
            TestUniforms uniforms(3);
            double farthest = 0;
            int seams = 0;
            for (int i = 0; i < 40000; ++i) {
                const Vec2d u = uniforms.next_2d();
                double z = 2 * u.x - 1, phi = 2 * pi * u.y;
                // On the seams of both layouts: phi = 0 and the meridians of the octahedron's corners.
                if (i % 2 == 0) phi = (i / 2 % 4) * pi / 2 + (u.y - 0.5) * 1e-3;
                // All texels of a latitude-longitude map meet at its poles.
                if (layout == EnvironmentLayout::equirectangular) z *= 0.9;
                const double r = std::sqrt(1 - z * z);
                const Vec3f a(Vec3d{r * std::cos(phi), r * std::sin(phi), z});
                const Vec3d step{uniforms.next() - 0.5, uniforms.next() - 0.5, uniforms.next() - 0.5};
                const Vec3f b(normalize(Vec3d(a) + 1e-3 * step));
                const Vec2f p = grid.locate(a), q = grid.locate(b);
                seams += std::abs(p.x - q.x) > 1 || std::abs(p.y - q.y) > 1;
                farthest = std::max(farthest, std::abs(blended(map, grid, p) - blended(map, grid, q)));
            }
            EXPECT_GT(seams, 300);
            // 40 a texel, over at most 1e-3 of the sphere at the widest stretch of texels.
            EXPECT_LT(farthest, 1.5) << width;
        }
}

std::vector<MapCase> map_cases() {
    std::vector<MapCase> cases;
    cases.push_back({"rough", rough_map(16, 16)});
    cases.push_back({"spikes", map_of(
                                   16, 16,
                                   [](int x, int y) {
                                       return (x == 0 && y == 0) || (x == 9 && y == 15) ? 1e3
                                              : x == 15 && y == 7                       ? 50
                                                                                        : 0;
                                   },
                                   grey)});
    return cases;
}
void for_each_sampler(const auto& f) { for_each_sampler(map_cases(), EnvironmentLookup::bilinear, f); }

// Over the parts of cells that a quarter of texels make, whose solid angles are equal in a texel; density and
// samples are compared there.
TEST(EnvironmentLookup, DirectionsFollowTheirDensity) {
    for_each_sampler([](const Image& map, const EnvironmentSampler& sampler) {
        // Regions and strata are tested with maps that are looked up in the nearest texel.
        if (sampler.sampling() != EnvironmentSampling::tabulated) return;
        const EnvironmentGrid& grid = sampler.grid();
        const int parts = 4, inner = 4;
        const auto columns = static_cast<std::size_t>(map.width() * parts);
        std::vector<double> expected(columns * columns), counts(expected.size());
        const int n = 60000;
        double all = 0;
        for (int y = 0; y < map.height() * parts * inner; ++y)
            for (int x = 0; x < map.width() * parts * inner; ++x) {
                const Vec2f p{(static_cast<float>(x) + 0.5f) / (parts * inner),
                              (static_cast<float>(y) + 0.5f) / (parts * inner)};
                const double e = static_cast<double>(sampler.pdf(p)) * grid.solid_angle(y / (parts * inner)) /
                                 (parts * inner * parts * inner);
                expected[static_cast<std::size_t>(y / inner) * columns +
                         static_cast<std::size_t>(x / inner)] += n * e;
                all += e;
            }
        EXPECT_NEAR(all, 1, 2e-3);
        for (double& e : expected) e /= all;
        TestUniforms uniforms(5);
        for (int i = 0; i < n; ++i) {
            const EnvironmentPoint s = sampler.sample(uniforms.next_2f());
            ASSERT_GT(s.pdf, 0);
            ASSERT_NEAR(sampler.pdf(s.grid) / s.pdf, 1, 1e-3);
            counts.at(static_cast<std::size_t>(s.grid.y * parts) * columns +
                      static_cast<std::size_t>(s.grid.x * parts)) += 1;
        }
        const TestResult r = chi_squared_test(counts, expected);
        EXPECT_TRUE(r.passes(1e-9)) << r.description;
    });
}

TEST(EnvironmentLookup, NothingIsLeftOutAndTheLightIsThatOfTheBlend) {
    for_each_sampler([](const Image& map, const EnvironmentSampler& sampler) {
        const EnvironmentGrid& grid = sampler.grid();
        TestUniforms uniforms(6);
        const double total = sampler.mean_radiance() * 4 * pi;
        RunningMoments uniform, drawn;
        for (int i = 0; i < 40000; ++i) {
            const Vec2d u = uniforms.next_2d();
            const Vec2f p{static_cast<float>(u.x * map.width()), static_cast<float>(u.y * map.height())};
            const double l = blended(map, grid, p);
            uniform.add(l * grid.solid_angle(static_cast<int>(p.y)) * map.width() * map.height());
            if (sampler.compensated()) continue;
            const auto pdf = static_cast<double>(sampler.pdf(p));
            if (l > 1e-3) {
                ASSERT_GT(pdf, 0) << p.x << " " << p.y;
            }
            if (sampler.sampling() == EnvironmentSampling::tabulated) {
                ASSERT_NEAR(pdf * total, l, 1e-4 * l + 1e-4);
            }
            const EnvironmentPoint s = sampler.sample(uniforms.next_2f());
            drawn.add(blended(map, grid, s.grid) / static_cast<double>(s.pdf));
        }
        EXPECT_NEAR(uniform.mean() / total, 1, 6.5 * uniform.standard_error() / total);
        if (!sampler.compensated()) {
            EXPECT_NEAR(drawn.mean() / total, 1, 6.5 * drawn.standard_error() / total + 1e-4);
        }
    });
}

} // namespace
} // namespace montelux::environment_lookup
