// Sampling of real environment maps: every strategy follows its density, and each way to use it is unbiased
// for every material. 24 chi-squared tests at 1e-9 each and 216 means at 6.5 standard errors (8e-11): below
// 1e-7 for the file.
#include "bench/environment_estimate.h"
#include <gtest/gtest.h>
#include <optional>
#include <string>

#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

using bench::EnvironmentPicture;
using bench::Use;

std::optional<EnvironmentPicture> environment(const std::string& name) {
    const std::filesystem::path path = std::filesystem::path(MONTELUX_SHARED_DIR) / "environments" / name;
    if (!std::filesystem::exists(path)) return std::nullopt;
    return bench::read_environment(path);
}

struct LookupStrategy {
    EnvironmentSampling sampling;
    bool compensated;
};
constexpr LookupStrategy strategies[] = {
    {EnvironmentSampling::tabulated, false},  {EnvironmentSampling::tabulated, true},
    {EnvironmentSampling::median_cut, false}, {EnvironmentSampling::median_cut, true},
    {EnvironmentSampling::structured, false}, {EnvironmentSampling::structured, true}};

class EnvironmentMapsSlowTest : public ::testing::TestWithParam<const char*> {};
std::string map_name(const ::testing::TestParamInfo<const char*>& info) {
    const std::string file = info.param;
    return file.substr(0, file.find('.'));
}
INSTANTIATE_TEST_SUITE_P(Maps, EnvironmentMapsSlowTest,
                         ::testing::Values("forest.hdr", "night.hdr", "studio.hdr", "sunrise.hdr"), map_name);

// Blocks of 8 x 8 texels; the density of a block by 16 points in each texel.
TEST_P(EnvironmentMapsSlowTest, DirectionsFollowTheDensity) {
    const auto map = environment(GetParam());
    if (!map) GTEST_SKIP() << "no environment maps";
    constexpr int block = 8, points = 16, samples = 400000;
    for (const LookupStrategy& s : strategies) {
        const EnvironmentSampler sampler(map->image, map->layout, {s.sampling, s.compensated});
        SCOPED_TRACE(sampler.description());
        const EnvironmentGrid& grid = sampler.grid();
        const int columns = grid.width() / block, rows = grid.height() / block;
        std::vector<double> expected(static_cast<std::size_t>(columns) * rows), observed = expected;
        parallel_for(rows, [&](std::int64_t row) {
            for (int y = static_cast<int>(row) * block; y < (static_cast<int>(row) + 1) * block; ++y)
                for (int x = 0; x < grid.width(); ++x)
                    for (int k = 0; k < points; ++k) {
                        const double i = (k + 0.5) / points, j = std::fmod((k + 0.5) * 0.6180339887, 1.0);
                        expected[static_cast<std::size_t>(row) * columns + x / block] +=
                            double(sampler.pdf(Vec2f(Vec2d(x + i, y + j)))) * grid.solid_angle(y) / points;
                    }
        });
        double sum = 0;
        for (const double e : expected) sum += e;
        EXPECT_NEAR(sum, 1, 2e-3);
        for (double& e : expected) e *= samples / sum;
        TestUniforms uniforms(17);
        for (int i = 0; i < samples; ++i) {
            const Vec2f g = sampler.sample(uniforms.next_2f()).grid;
            observed[static_cast<std::size_t>(static_cast<int>(g.y) / block * columns +
                                              static_cast<int>(g.x) / block)] += 1;
        }
        const TestResult r = chi_squared_test(observed, expected, 20);
        EXPECT_TRUE(r.passes(1e-9)) << r.description;
    }
}

// The mean of 256 seeds beside a sum over texels, for light samples alone and joined with those of the BSDF.
TEST_P(EnvironmentMapsSlowTest, EachWayIsUnbiasedForEachMaterial) {
    const auto map = environment(GetParam());
    if (!map) GTEST_SKIP() << "no environment maps";
    constexpr int seeds = 256, parts = 3;
    constexpr std::uint32_t samples = 2048;
    double worst = 0;
    for (const bench::EnvironmentMaterial& material : bench::environment_materials()) {
        for (const int normal : {3, 16}) {
            const Frame frame = bench::frame_of(normal);
            const EnvironmentGrid grid(map->layout, map->image.width(), map->image.height());
            std::vector<double> sums(static_cast<std::size_t>(grid.height()));
            parallel_for(grid.height(), [&](std::int64_t row) {
                const int y = static_cast<int>(row);
                SampleStream unused({SamplerKind::independent, 1, 1}, 0, 0, 0);
                for (int x = 0; x < grid.width(); ++x)
                    for (int k = 0; k < parts * parts; ++k) {
                        const Vec2d place{x + (k % parts + 0.5) / parts,
                                          y + (static_cast<int>(k / parts) + 0.5) / parts};
                        const Vec3f wi = frame.to_local(grid.direction(place));
                        const float f = std::visit(
                            [&](const auto& b) {
                                return b.evaluate(bench::view, wi, TransportMode::radiance, unused).f[0];
                            },
                            material.bsdf);
                        sums[static_cast<std::size_t>(y)] += double(f) *
                                                             double(map->radiance[grid.texel(Vec2f(place))]) *
                                                             grid.solid_angle(y) / (parts * parts);
                    }
            });
            double exact = 0;
            for (const double s : sums) exact += s;
            for (const LookupStrategy& s : strategies) {
                const EnvironmentSampler sampler(map->image, map->layout, {s.sampling, s.compensated});
                for (const Use use : {Use::light, Use::power}) {
                    if (use == Use::light && s.compensated) continue; // its density is zero where light is
                    std::vector<double> means(seeds);
                    parallel_for(seeds, [&](std::int64_t seed) {
                        const SamplerSettings settings{SamplerKind::independent,
                                                       static_cast<std::uint64_t>(seed), samples};
                        double sum = 0;
                        for (std::uint32_t i = 0; i < samples; ++i) {
                            SampleStream stream(settings, 0, 0, i);
                            sum += bench::estimate(map->radiance, sampler, material.bsdf, frame, use, stream);
                        }
                        means[static_cast<std::size_t>(seed)] = sum / samples;
                    });
                    RunningMoments all;
                    for (const double mean : means) all.add(mean);
                    // Half a thousandth: floats, and the rule over texels.
                    const double z = (all.mean() - exact) / all.standard_error();
                    worst = std::max(worst, std::abs(z));
                    EXPECT_NEAR(all.mean(), exact, 6.5 * all.standard_error() + 5e-4 * exact)
                        << sampler.description() << ", " << material.name << ", normal " << normal << ", z "
                        << z;
                }
            }
        }
    }
    RecordProperty("largest_z", std::to_string(worst));
}

} // namespace
} // namespace montelux
