// Points of mixtures that the emulated device draws, and adaptive integration with them: the processor's bits.
#include "test/mc/integrate/estimator_checks.h"
#include "test/mc/integrate/integrate_testing.h"
#include "test/mc/integrate/on_emulated_device.h"
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/integrate/adaptive/device_mixture.h"
#include "montelux/mc/integrate/adaptive/mixture_sampling.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

class MixtureOnEmulatedDevice : public OnEmulatedDevice {};

// All channels, a singular map, and Gaussians that lie partly outside the cube.
MixtureDensity all_channels() {
    const std::vector<MonotoneMap> maps{MonotoneMap({0, 0.1, 0.4, 1}, {1, 3, 0.2}),
                                        MonotoneMap({0, 0.01, 0.5, 1}, {1, 2, 2}, 0.25), MonotoneMap()};
    const std::vector<Gaussian> gaussians{
        Gaussian({0.2, 0.9, 0.5}, {0.2, 0, 0, 0.05, 0.1, 0, -0.02, 0.03, 0.3}),
        Gaussian({0.7, 0.1, 0.98}, {0.03, 0, 0, 0.01, 0.2, 0, 0.02, -0.04, 0.1})};
    MixtureDensity mixture(3, maps, gaussians, true);
    mixture.set_shares({8, 4, 20, 12, 20});
    return mixture;
}

TEST_F(MixtureOnEmulatedDevice, PointsHaveTheProcessorsBits) {
    constexpr int dimensions = 3, replicates = 2;
    constexpr std::uint64_t begin = 64, end = 1088;
    const MixtureDensity mixture = all_channels();
    const Evaluator g(integrand(coordinates(dimensions), dimensions, dimensions),
                      Domain::unit_cube(dimensions));
    const auto device = DeviceValues::of(g);
    set_mixture(device->sampler(), mixture, 99, replicates, begin, end);
    device->draw_mixture(0, replicates * (end - begin));
    std::uint64_t number = 0, outside = 0;
    for (std::uint32_t r = 0; r < replicates; ++r)
        for (int k = 0; k < mixture.channels(); ++k) {
            const std::uint64_t first = mixture.channel_points(k, begin),
                                count = mixture.channel_points(k, end) - first;
            PointBuffer u(count, dimensions), x;
            std::vector<double> density, density_there;
            ScrambledSobol(dimensions, hash_key(99, k), r).fill(u, first);
            mixture.sample(k, u, x, density);
            ValueBuffer there;
            NonFiniteCount none;
            device->read_inside(number, count, there, density_there, {}, none);
            ASSERT_EQ(density_there, density) << k;
            outside += count - density.size();
            for (int d = 0; d < dimensions; ++d)
                for (std::size_t i = 0; i < density.size(); ++i)
                    ASSERT_EQ(std::as_const(there)(i, d), x(i, d)) << k << " " << d << " " << i;
            number += count;
        }
    EXPECT_GT(outside, 100u);
}

TEST_F(MixtureOnEmulatedDevice, SumsHaveTheProcessorsBits) {
    const Domain domain({{0, infinity}, {-1, 2}, {0, 1}});
    const std::string text = "double integrand(int, const double* x) {\n"
                             "    return x[1] > 1.9 ? nan(\"\") : exp(-x[0]) * x[2];\n"
                             "}\n";
    const Integrand here = [](std::span<const double> x) {
        return x[1] > 1.9 ? std::nan("") : std::exp(-x[0]) * x[2];
    };
    const Evaluator there(integrand(text, 3), domain), cpu(here, domain);
    const auto device = DeviceValues::of(there);
    const MixtureDensity mixture = all_channels();
    const auto a = sample_mixture(there, mixture, 7, 4, 640, 6400, nullptr, nullptr, device.get());
    const auto b = sample_mixture(cpu, mixture, 7, 4, 640, 6400, nullptr, nullptr);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->sums.all(), b->sums.all());
    EXPECT_EQ(a->evaluations, b->evaluations);
    EXPECT_LT(a->evaluations, 4u * (6400 - 640)); // points outside the cube cost none
    EXPECT_GT(a->non_finite.count, 100u);
    EXPECT_EQ(a->non_finite.count, b->non_finite.count);
    EXPECT_EQ(a->non_finite.first_point, b->non_finite.first_point);
    for (std::size_t k = 0; k < b->channels.size(); ++k) {
        EXPECT_EQ(a->channels[k].count, b->channels[k].count);
        EXPECT_EQ(a->channels[k].sum, b->channels[k].sum);
        EXPECT_EQ(a->channels[k].squares, b->channels[k].squares);
    }
}

TEST_F(MixtureOnEmulatedDevice, CompilingCountsForNoTimeLimit) {
    const Integrand there = integrand("double integrand(int, const double* x) { return x[0]; }", 2);
    const IntegrationResult r = integrate(there, Domain::unit_cube(2), Adaptive{},
                                          {.time = std::chrono::milliseconds(100)}); // compilers take longer
    EXPECT_GT(r.evaluations, 0u);
    EXPECT_NEAR(r.value[0], 0.5, 0.1);
}

struct DrawnIntegrand {
    const char* name;
    int dimensions;
    std::string there;
    double (*here)(std::span<const double>);
};

// Two peaks that maps do not fit, a singular corner, and a smooth function.
const DrawnIntegrand drawn_integrands[] = {
    {"peaks", 4,
     "double integrand(int n, const double* x) {\n"
     "    double a = 0, b = 0;\n"
     "    for (int d = 0; d < n; ++d) {\n"
     "        a += (x[d] - 0.3) * (x[d] - 0.3);\n"
     "        b += (x[d] - 0.7) * (x[d] - 0.7);\n"
     "    }\n"
     "    return exp(-400 * a) + exp(-900 * b);\n"
     "}\n",
     [](std::span<const double> x) {
         double a = 0, b = 0;
         for (const double v : x) {
             a += (v - 0.3) * (v - 0.3);
             b += (v - 0.7) * (v - 0.7);
         }
         return std::exp(-400 * a) + std::exp(-900 * b);
     }},
    {"corner", 2, "double integrand(int, const double* x) { return pow(x[0] + x[1], -1.2); }\n",
     [](std::span<const double> x) { return std::pow(x[0] + x[1], -1.2); }},
    {"smooth", 3, "double integrand(int, const double* x) { return 1 + x[0] * x[1] * exp(x[2]); }\n",
     [](std::span<const double> x) { return 1 + x[0] * x[1] * std::exp(x[2]); }}};

TEST_F(MixtureOnEmulatedDevice, AdaptiveEstimatesHaveTheProcessorsBits) {
    for (const DrawnIntegrand& c : drawn_integrands) {
        OnDevice counted = integrand(c.there, c.dimensions).on_device();
        std::uint64_t drawn = 0;
        counted.before.emplace_back([&drawn](std::size_t points) { drawn += points; });
        const Integrand there = Integrand::compiled(counted.function).with_device(counted);
        const auto expect_same = [&](const Budget& budget, std::uint64_t seed) {
            const Domain cube = Domain::unit_cube(c.dimensions);
            const IntegrationResult a = integrate(there, cube, Adaptive{}, budget, {.seed = seed});
            const IntegrationResult b =
                integrate(Integrand(c.here), cube, Adaptive{}, budget, {.seed = seed});
            EXPECT_TRUE(same_but_for_time(a, b))
                << c.name << ": " << to_string(a) << " instead of " << to_string(b);
        };
        expect_same({.evaluations = 200'000}, 1);
        EXPECT_GT(drawn, 120'000u) << c.name << ": the device does not draw the samples";
        for (std::uint64_t seed = 2; seed < 4; ++seed) expect_same({.relative_error = 3e-3}, seed);
    }
}

} // namespace
} // namespace montelux
