// Sampling of environment maps: every strategy follows its density, on maps that are odd as well, and gives
// the map's light. 96 chi-squared tests at 1e-8 each and 48 sums at 5.8 standard errors (7e-9): below 2e-6
// for the file.
#include "test/scene/environment_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/light/environment/environment_sampler.h"

namespace montelux {
namespace {

std::vector<MapCase> map_cases() {
    std::vector<MapCase> cases;
    cases.push_back({"1x1", map_of(1, 1, [](int, int) { return 3; })});
    cases.push_back({"2x1", map_of(2, 1, [](int x, int) { return 1 + 3 * x; })});
    cases.push_back({"constant", map_of(16, 16, [](int, int) { return 0.3; })});
    cases.push_back(
        {"single texel", map_of(32, 32, [](int x, int y) { return x == 20 && y == 9 ? 1e4 : 0; })});
    cases.push_back({"sun", map_of(64, 32, [](int x, int y) { return x == 41 && y == 7 ? 3e3 : 1 + y; })});
    cases.push_back({"gradient", map_of(24, 12, [](int x, int y) { return x + 0.1 * y; })});
    cases.push_back({"black half", map_of(32, 32, [](int x, int) { return x < 16 ? 0 : 2; })});
    TestUniforms uniforms(4);
    cases.push_back({"random", map_of(64, 64, [&](int x, int y) {
                         double u = uniforms.next();
                         return (x * y) % 7 == 0 ? 0 : std::exp(6 * u * u);
                     })});
    return cases;
}

void for_each_sampler(const auto& f) { for_each_sampler(map_cases(), EnvironmentLookup::nearest, f); }

double light_of(const Image& map, std::size_t texel) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += static_cast<double>(map.value_at(3 * texel + c));
    return sum / 3;
}

TEST(EnvironmentGrid, PlacesAndDirectionsAgree) {
    for (EnvironmentLayout layout : environment_layouts)
        for (auto [width, height] : {std::pair(1, 1), {2, 1}, {7, 5}, {64, 32}, {4096, 2048}}) {
            const EnvironmentGrid grid(layout, width, height);
            double sum = 0;
            for (int y = 0; y < height; ++y) {
                sum += grid.solid_angle(y) * width;
                EXPECT_NEAR(4 * pi * (grid.share_above(y + 1) - grid.share_above(y)) / width,
                            grid.solid_angle(y), 1e-9 * grid.solid_angle(y) + 1e-14);
                const double line = y + 0.25;
                EXPECT_NEAR(grid.line_below(grid.share_above(line)), line, 1e-6 * height) << y;
            }
            EXPECT_NEAR(sum, 4 * pi, 1e-10);
            TestUniforms uniforms(3);
            for (int i = 0; i < 2000; ++i) {
                Vec2f u = uniforms.next_2f();
                const Vec2f place{std::min(u.x * width, std::nextafter(static_cast<float>(width), 0.0f)),
                                  std::min(u.y * height, std::nextafter(static_cast<float>(height), 0.0f))};
                const Vec3f w = grid.direction(place);
                ASSERT_NEAR(length(w), 1, 1e-6);
                const Vec2f back = grid.locate(w);
                ASSERT_LT(back.x, width);
                ASSERT_LT(back.y, height);
                // Near the poles columns are narrow.
                ASSERT_LT(length(grid.direction(back) - w), 2e-6f) << place.x << " " << place.y;
            }
            // A direction that is none still has a texel.
            EXPECT_LT(grid.texel(grid.locate(Vec3f(NAN, NAN, NAN))), grid.texel_count());
            for (Vec3f w : {Vec3f{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, -1, 0}})
                EXPECT_LT(grid.texel(grid.locate(w)), grid.texel_count());
        }
}

// Rows of latitude-longitude maps go from +z to -z, columns from +x towards +y.
TEST(EnvironmentGrid, LatitudeAndLongitude) {
    const EnvironmentGrid grid(EnvironmentLayout::equirectangular, 8, 4);
    auto texel_of = [&](double theta, double phi) {
        const double s = std::sin(theta);
        return grid.texel(grid.locate(Vec3f(Vec3d(s * std::cos(phi), s * std::sin(phi), std::cos(theta)))));
    };
    for (std::size_t y = 0; y < 4; ++y)
        for (std::size_t x = 0; x < 8; ++x)
            for (double du : {0.01, 0.99})
                for (double dv : {0.01, 0.99})
                    EXPECT_EQ(texel_of((y + dv) * pi / 4, (x + du) * pi / 4), y * 8 + x);
}

// Over the grid, where a texel is a unit square, by cells of a quarter of a texel.
TEST(EnvironmentSamplers, DirectionsFollowTheirDensity) {
    for_each_sampler([](const Image&, const EnvironmentSampler& sampler) {
        const EnvironmentGrid& grid = sampler.grid();
        constexpr int parts = 2, points = 32; // cells along a texel, points of the quadrature in a cell
        const int columns = parts * grid.width(), rows = parts * grid.height();
        std::vector<double> observed(static_cast<std::size_t>(columns * rows)), expected = observed;
        constexpr int samples = 20000;
        double sum = 0;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                double mean = 0;
                for (int k = 0; k < points; ++k) {
                    // A lattice: regions can be slivers.
                    const double i = (k + 0.5) / points, j = std::fmod((k + 0.5) * 0.6180339887, 1.0);
                    mean += double(sampler.pdf(Vec2f(Vec2d((x + i) / parts, (y + j) / parts)))) / points;
                }
                const double p = mean * grid.solid_angle(y / parts) / (parts * parts);
                expected[static_cast<std::size_t>(y * columns + x)] = p * samples;
                sum += p;
            }
        // The density integrates to one; cuts within cells cost the quadrature a little.
        EXPECT_NEAR(sum, 1, 5e-3);
        for (double& e : expected) e /= sum;
        TestUniforms uniforms(11);
        for (int i = 0; i < samples; ++i) {
            const Vec2f g = sampler.sample(uniforms.next_2f()).grid;
            observed[static_cast<std::size_t>(static_cast<int>(g.y * parts) * columns +
                                              static_cast<int>(g.x * parts))] += 1;
        }
        const TestResult r = chi_squared_test(observed, expected, 20);
        EXPECT_TRUE(r.passes(1e-8)) << r.description;
    });
}

// What a sample says of its density is what the density says of it, and light is never left out.
TEST(EnvironmentSamplers, DensitiesAreThoseOfTheSamples) {
    for_each_sampler([](const Image& map, const EnvironmentSampler& sampler) {
        const EnvironmentGrid& grid = sampler.grid();
        TestUniforms uniforms(6);
        for (int i = 0; i < 2000; ++i) {
            const EnvironmentPoint s = sampler.sample(uniforms.next_2f());
            ASSERT_GE(s.grid.x, 0);
            ASSERT_LT(s.grid.x, grid.width());
            ASSERT_GE(s.grid.y, 0);
            ASSERT_LT(s.grid.y, grid.height());
            ASSERT_GT(s.pdf, 0);
            ASSERT_FLOAT_EQ(s.pdf, sampler.pdf(s.grid)) << s.grid.x << " " << s.grid.y;
        }
        for (Vec2f corner :
             {Vec2f{0, 0}, Vec2f{1 - 6e-8f, 0}, Vec2f{0, 1 - 6e-8f}, Vec2f{1 - 6e-8f, 1 - 6e-8f}})
            ASSERT_LT(grid.texel(sampler.sample(corner).grid), grid.texel_count());
        if (sampler.compensated()) return;
        for (int y = 0; y < grid.height(); ++y)
            for (int x = 0; x < grid.width(); ++x)
                for (Vec2f within : {Vec2f{0, 0}, Vec2f{0.5f, 0.5f}, Vec2f{0.999f, 0.999f}}) {
                    const Vec2f place{static_cast<float>(x) + within.x, static_cast<float>(y) + within.y};
                    if (light_of(map, grid.texel(place)) > 0) {
                        ASSERT_GT(sampler.pdf(place), 0) << place.x << " " << place.y;
                    }
                }
    });
}

// E[L max(cos, 0) / pdf] over many seeds is the irradiance of a plane, which is a sum over texels.
TEST(EnvironmentSamplers, UnbiasedIrradiance) {
    const Vec3f n = normalize(Vec3f{0.3f, -0.5f, 0.8f});
    for_each_sampler([&](const Image& map, const EnvironmentSampler& sampler) {
        if (sampler.compensated()) return;
        const EnvironmentGrid& grid = sampler.grid();
        // By quadrature within texels, uniform in solid angle.
        const int parts = std::max(1, 256 / grid.width());
        double exact = 0;
        for (int y = 0; y < grid.height(); ++y)
            for (int x = 0; x < grid.width(); ++x)
                for (int j = 0; j < parts; ++j)
                    for (int i = 0; i < parts; ++i) {
                        const Vec2f place(Vec2d(x + (i + 0.5) / parts, y + (j + 0.5) / parts));
                        exact += light_of(map, grid.texel(place)) * grid.solid_angle(y) / (parts * parts) *
                                 std::max(0.0, double(dot(grid.direction(place), n)));
                    }
        RunningMoments means;
        for (std::uint64_t seed = 0; seed < 256; ++seed) {
            TestUniforms uniforms(seed);
            double sum = 0;
            constexpr int samples = 128;
            for (int i = 0; i < samples; ++i) {
                const EnvironmentPoint s = sampler.sample(uniforms.next_2f());
                const double cosine = double(dot(grid.direction(s.grid), n));
                if (cosine > 0) sum += light_of(map, grid.texel(s.grid)) * cosine / double(s.pdf);
            }
            means.add(sum / samples);
        }
        // 5.8 standard errors: 7e-9.
        EXPECT_NEAR(means.mean(), exact, 5.8 * means.standard_error() + 1e-3 * exact);
    });
}

// With compensation the light that is left out is that of a sky of the mean, and constant maps stay.
TEST(EnvironmentSamplers, CompensationTakesTheMeanAway) {
    for (EnvironmentLayout layout : environment_layouts) {
        const Image map = map_of(64, 64, [](int x, int y) { return 1 + (x * 7 + y * 3) % 11; });
        const EnvironmentSampler sampler(map, layout, {EnvironmentSampling::tabulated, true});
        ASSERT_TRUE(sampler.compensated());
        const EnvironmentGrid& grid = sampler.grid();
        double left = 0;
        for (std::size_t i = 0; i < grid.texel_count(); ++i)
            left += std::max(0.0, light_of(map, i) - sampler.mean_radiance()) *
                    grid.solid_angle(static_cast<int>(i / 64));
        for (std::size_t i = 0; i < grid.texel_count(); i += 17) {
            const Vec2f place(Vec2d(static_cast<double>(i % 64) + 0.5, static_cast<double>(i / 64) + 0.5));
            const double expected = std::max(0.0, light_of(map, i) - sampler.mean_radiance()) / left;
            EXPECT_NEAR(double(sampler.pdf(place)), expected, 1e-4 * expected + 1e-7) << i;
        }
        for (double ripple : {0.0, 1e-6, 1e-3}) {
            const Image flat =
                map_of(32, 32, [&](int x, int y) { return 0.1 * (1 + ripple * ((x + y) % 2)); });
            for (EnvironmentSampling kind : environment_kinds) {
                const EnvironmentSampler even(flat, layout, {kind, true});
                EXPECT_FALSE(even.compensated()) << ripple;
                if (kind == EnvironmentSampling::tabulated) {
                    EXPECT_NEAR(double(even.pdf({3.5f, 4.5f})), inv_four_pi, 2e-3 * inv_four_pi);
                }
            }
        }
    }
}

TEST(EnvironmentSamplers, SunsAreSampledByTheirTexels) {
    const Image map = map_of(64, 64, [](int x, int y) {
        if (x == 30 && y == 40) return 60000;
        return x == 31 && y == 40 ? 20000 : 2;
    });
    for (EnvironmentSampling kind : {EnvironmentSampling::median_cut, EnvironmentSampling::structured}) {
        const EnvironmentSampler sampler(map, EnvironmentLayout::equal_area, {kind, false});
        ASSERT_NE(sampler.sun(), nullptr);
        EXPECT_EQ(sampler.sun()->texels(), 2u);
        EXPECT_NEAR(sampler.sun()->share(), 80000 / (80000 + 2.0 * (64 * 64 - 2)), 1e-5);
        EXPECT_NEAR(double(sampler.pdf({30.5f, 40.5f}) / sampler.pdf({31.5f, 40.5f})), 3, 1e-3);
        TestUniforms uniforms(8);
        int in_sun = 0;
        for (int i = 0; i < 10000; ++i) {
            const Vec2f g = sampler.sample(uniforms.next_2f()).grid;
            in_sun += g.x >= 30 && g.x < 32 && g.y >= 40 && g.y < 41;
        }
        // The rest shares 9.3 % out over the sky.
        EXPECT_NEAR(in_sun, 9071, 150);
    }
    // A wide bright sky is no sun, nor are many small lamps.
    const Image wide = map_of(64, 64, [](int x, int y) { return x < 8 && y < 8 ? 500 : 1; });
    const Image lamps = map_of(64, 64, [](int x, int y) { return x % 8 == 3 && y % 8 == 5 ? 500 : 1; });
    for (const Image* image : {&wide, &lamps})
        EXPECT_EQ(EnvironmentSampler(*image, EnvironmentLayout::equal_area,
                                     {EnvironmentSampling::median_cut, false})
                      .sun(),
                  nullptr);
}

TEST(EnvironmentSamplers, MedianCutRegionsShareTheLightAlike) {
    for (EnvironmentLayout layout : environment_layouts) {
        const Image map = map_of(64, 64, [](int x, int y) { return y < 8 ? 0 : 1 + (x * 13 + y * 7) % 23; });
        const EnvironmentGrid grid(layout, 64, 64);
        const std::vector<float> light = texel_light(map, grid);
        const MedianCutEnvironment cut(grid, light, 6);
        ASSERT_EQ(cut.regions().size(), 64u);
        double area = 0;
        for (const auto& r : cut.regions()) {
            EXPECT_GE(r.y0, 8); // nothing of the black border
            double sum = 0;
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x) {
                    auto overlap = [](float a, float b, int i) {
                        return std::max(0.0, std::min(double(b), i + 1.0) - std::max(double(a), double(i)));
                    };
                    sum += overlap(r.x0, r.x1, x) * overlap(r.y0, r.y1, y) *
                           double(light[static_cast<std::size_t>(y * 64 + x)]);
                }
            EXPECT_NEAR(sum, sum_of(light) / 64, 1e-4 * sum_of(light) / 64);
            area += (r.share1 - r.share0) * double(r.x1 - r.x0) / 64;
        }
        EXPECT_NEAR(area, 1 - grid.share_above(8), 1e-5);
    }
}

TEST(EnvironmentSamplers, StructuredStrataAreSharedOutByImportance) {
    // A lamp of 4 x 4 texels on a faint sky.
    const Image map = map_of(64, 64, [](int x, int y) { return x / 4 == 5 && y / 4 == 9 ? 200 : 1; });
    const EnvironmentGrid grid(EnvironmentLayout::equal_area, 64, 64);
    const std::vector<float> light = texel_light(map, grid);
    const StructuredEnvironment structured(grid, light, 256);
    std::vector<double> cells(structured.strata());
    std::size_t in_lamp = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            cells[structured.stratum_of({static_cast<float>(x), static_cast<float>(y)})] += 1;
    std::vector<bool> of_lamp(structured.strata());
    for (int y = 36; y < 40; ++y)
        for (int x = 20; x < 24; ++x)
            of_lamp[structured.stratum_of({static_cast<float>(x), static_cast<float>(y)})] = true;
    for (std::size_t s = 0; s < cells.size(); ++s) {
        EXPECT_GT(cells[s], 0);
        in_lamp += of_lamp[s];
    }
    for (std::size_t s = 0; s < cells.size(); ++s) {
        EXPECT_EQ(structured.stratum_of(structured.centre_of(s)), s);
        EXPECT_EQ(structured.level_of(s) > 0, of_lamp[s]);
    }
    const double texel = 4 * pi / (64 * 64), lamp = 200.0 * 16 * std::pow(std::min(16 * texel, 0.01), 0.25),
                 sky = (64 * 64 - 16) * std::pow(0.01, 0.25);
    EXPECT_NEAR(static_cast<double>(in_lamp), std::min(16.0, 256 * lamp / (lamp + sky)), 1.0);
}

TEST(EnvironmentSamplers, TheRequestedNumberOfParts) {
    using enum EnvironmentSampling;
    const Image map = map_of(64, 32, [](int x, int y) { return 1 + (x * 13 + y * 7) % 23; });
    auto made = [&](EnvironmentSampling kind, int parts) {
        return EnvironmentSampler(map, EnvironmentLayout::equirectangular,
                                  {.sampling = kind, .parts = parts});
    };
    EXPECT_EQ(made(median_cut, 0).median_cut()->regions().size(), 4096u);
    EXPECT_EQ(made(median_cut, 32).median_cut()->regions().size(), 32u);
    EXPECT_EQ(made(median_cut, 1).median_cut()->regions().size(), 1u);
    EXPECT_EQ(made(median_cut, 1).structured(), nullptr);
    EXPECT_NEAR(static_cast<double>(made(structured, 0).structured()->strata()), 1024, 50);
    EXPECT_NEAR(static_cast<double>(made(structured, 100).structured()->strata()), 100, 10);
    EXPECT_EQ(made(structured, 100).median_cut(), nullptr);
    for (const int wrong : {-1, 3, 1 << 17}) EXPECT_THROW(made(median_cut, wrong), Error);
    for (const int wrong : {-1, 1 << 17}) EXPECT_THROW(made(structured, wrong), Error);
    for (const EnvironmentSampling kind : {tabulated, automatic}) EXPECT_THROW(made(kind, 64), Error);
}

TEST(EnvironmentSamplers, TheSameForAnyNumberOfThreads) {
    const Image map = map_cases().back().map;
    for (EnvironmentLayout layout : environment_layouts)
        for (EnvironmentSampling kind : environment_kinds) {
            auto draws = [&] {
                const EnvironmentSampler sampler(map, layout, {kind, true});
                TestUniforms uniforms(2);
                std::vector<float> values;
                for (int i = 0; i < 500; ++i) {
                    const EnvironmentPoint s = sampler.sample(uniforms.next_2f());
                    values.insert(values.end(), {s.grid.x, s.grid.y, s.pdf});
                }
                return values;
            };
            const auto one = with_threads(1, draws);
            EXPECT_EQ(one, with_threads(2, draws));
            EXPECT_EQ(one, with_threads(5, draws));
        }
}

TEST(EnvironmentSamplers, BlackMapsHaveDensities) {
    const Image black = map_of(8, 4, [](int, int) { return 0; });
    for (EnvironmentLayout layout : environment_layouts)
        for (EnvironmentSampling kind : environment_kinds)
            for (bool compensated : {false, true}) {
                const EnvironmentSampler sampler(black, layout, {kind, compensated});
                const EnvironmentPoint s = sampler.sample({0.3f, 0.6f});
                EXPECT_GT(s.pdf, 0);
                EXPECT_FLOAT_EQ(s.pdf, sampler.pdf(s.grid));
            }
}

// Light in one channel alone, beside a negative one, and light at the ends of what numbers hold.
TEST(EnvironmentSamplers, NoLightIsLostToRounding) {
    Image map(4, 4, {"R", "G", "B"});
    map.set(1, 1, 0, -5);
    map.set(1, 1, 1, 0.5f);
    map.set(2, 1, 2, 1e-44f);
    map.set(3, 3, 0, 3e38f);
    map.set(3, 3, 1, 3e38f);
    for (EnvironmentLayout layout : environment_layouts)
        for (EnvironmentSampling kind : environment_kinds) {
            const EnvironmentSampler sampler(map, layout, {kind, false});
            for (Vec2f place : {Vec2f{1.5f, 1.5f}, Vec2f{2.5f, 1.5f}, Vec2f{3.5f, 3.5f}})
                EXPECT_GT(sampler.pdf(place), 0) << sampler.description() << " " << place.x;
        }
}

} // namespace
} // namespace montelux
