// Integrals on a GPU: the processor's points, and its estimates up to the last bits of functions such as exp. Skipped
// where there is no GPU; the emulated device's tests hold everything else.
#include "test/mc/integrate/device_points.h"
#include "test/mc/integrate/integrate_testing.h"
#include "test/mc/integrate/on_emulated_device.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrate_log.h"
#include "montelux/mc/integrate/quasi/quasi.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/integrate/vegas/vegas.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

class OnGpu : public testing::Test {
  protected:
    void SetUp() override {
        if (std::getenv("MONTELUX_STAND_IN_DRIVER") != nullptr)
            GTEST_SKIP() << "a stand-in for the driver is loaded";
        try {
            device = Device::open("cuda");
        } catch (const Error& error) {
            // What the machine lacks; what does not work on one that has it is a failure.
            const std::string why = error.what();
            for (const char* const lacks : {"there is no NVIDIA driver", "shows no GPU", "is not installed"})
                if (why.find(lacks) != std::string::npos) GTEST_SKIP() << why;
            throw;
        }
    }
    std::shared_ptr<const DeviceFunction> compiled(const FunctionSource& source, int dimensions) const {
        return std::make_shared<const DeviceFunction>(device, source, dimensions);
    }
    Integrand integrand(const std::string& text, int dimensions, int components = 0) const {
        return Integrand::compiled(compiled({.text = text, .components = components}, dimensions));
    }

    std::shared_ptr<Device> device;
};

const Method methods_of_gpus[] = {BasicMonteCarlo{}, Quasi{}, Vegas{}, VegasSobol{}, Adaptive{}};

double peak_integral(int dimensions) {
    const double root = std::sqrt(20.0);
    return std::pow(std::sqrt(M_PI) / (2 * root) * (std::erf(0.7 * root) + std::erf(0.3 * root)), dimensions);
}

TEST_F(OnGpu, RandomPointsHaveTheProcessorsBits) { expect_random_points(device, 5000); }

TEST_F(OnGpu, SobolPointsHaveTheProcessorsBits) { expect_sobol_points(device, 3000); }

// Without exp the arithmetic is the processor's too, so that nothing differs.
TEST_F(OnGpu, PolynomialsHaveTheProcessorsBits) {
    const Integrand there =
        integrand("double integrand(int, const double* x) { return x[0] * x[1] + 0.1 * x[2] * x[2]; }", 3);
    const Integrand here = [](std::span<const double> x) { return x[0] * x[1] + 0.1 * x[2] * x[2]; };
    for (const Method& method : methods_of_gpus)
        for (const std::uint64_t evaluations : {6'000u, 900'000u}) {
            const IntegrationResult a =
                integrate(there, Domain::unit_cube(3), method, {.evaluations = evaluations});
            const IntegrationResult b =
                integrate(here, Domain::unit_cube(3), method, {.evaluations = evaluations});
            EXPECT_TRUE(same_but_for_time(a, b)) << method.name() << ", " << evaluations << ": "
                                                 << to_string(a) << " instead of " << to_string(b);
        }
}

// 100 seeds. Estimates that differ from the processor's in nothing but exp are equal up to rounding; methods that adapt
// may amplify that, and differ by a small part of their error. The mean of all seeds is the integral: false alarms below
// 1e-5 by the two-sided bound of 5 errors and 5 methods.
TEST_F(OnGpu, EstimatesAgreeWithTheProcessorsForAHundredSeeds) {
    const Integrand there = integrand(peak_source, 3), here = peak_here;
    constexpr int seeds = 100;
    for (const Method& method : methods_of_gpus) {
        const bool adapts = method.name() != "basic" && method.name() != "quasi";
        double sum_of_z = 0;
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            const Budget budget{.evaluations = 50'000};
            const IntegrationResult a =
                integrate(there, Domain::unit_cube(3), method, budget, {.seed = seed});
            const IntegrationResult b = integrate(here, Domain::unit_cube(3), method, budget, {.seed = seed});
            const double tolerance = adapts ? 0.1 * b.standard_error[0] : 1e-13 * b.value[0];
            EXPECT_NEAR(a.value[0], b.value[0], tolerance) << method.name() << ", seed " << seed;
            EXPECT_EQ(a.evaluations, b.evaluations) << method.name() << ", seed " << seed;
            sum_of_z += (a.value[0] - peak_integral(3)) / a.standard_error[0];
        }
        EXPECT_LT(std::abs(sum_of_z) / std::sqrt(seeds), 5) << method.name();
    }
}

TEST_F(OnGpu, SameBitsRunToRun) {
    for (const Method& method : methods_of_gpus) {
        const Budget budget{.evaluations = 5'000'000};
        const IntegrationResult a =
            integrate(integrand(peak_source, 4), Domain::unit_cube(4), method, budget);
        const IntegrationResult b =
            integrate(integrand(peak_source, 4), Domain::unit_cube(4), method, budget);
        EXPECT_TRUE(same_but_for_time(a, b))
            << method.name() << ": " << to_string(a) << ", then " << to_string(b);
        EXPECT_NEAR(a.value[0], peak_integral(4), 6 * a.standard_error[0]) << method.name();
    }
}

TEST_F(OnGpu, InfiniteRangesComponentsAndLogarithms) {
    const double inf = infinity;
    const Domain domain({{-inf, inf}, {0, inf}, {-inf, 2}, {-1, 3}});
    const Integrand there = integrand("void integrand(int, const double* x, int, double* y) {\n"
                                      "    y[0] = exp(-x[0] * x[0] - x[1] + (x[2] - 2));\n"
                                      "    y[1] = y[0] * x[3];\n"
                                      "}\n",
                                      4, 2);
    const Integrand logarithm =
        integrand("double integrand(int, const double* x) { return -5000 - x[0] * x[0] / 2; }", 1);
    for (const Method& method : methods_of_gpus) {
        const IntegrationResult r = integrate(there, domain, method, {.evaluations = 400'000});
        const double truth = 4 * std::sqrt(M_PI);
        EXPECT_NEAR(r.value[0], truth, 6 * r.standard_error[0]) << method.name();
        EXPECT_NEAR(r.value[1], truth, 6 * r.standard_error[1]) << method.name();
        EXPECT_LT(r.standard_error[0], 0.05 * truth) << method.name();
        const LogIntegrationResult z =
            integrate_log(logarithm, Domain::interval(-inf, inf), method, {.evaluations = 100'000});
        EXPECT_NEAR(z.log_value, -5000 + std::log(std::sqrt(2 * M_PI)), 6 * z.log_error) << method.name();
    }
}

TEST_F(OnGpu, ValuesThatAreNotFiniteAreCountedAndLocated) {
    const Integrand there =
        integrand("double integrand(int, const double* x) { return x[0] < 0.1 ? nan(\"\") : 1; }", 2);
    const Integrand here = [](std::span<const double> x) { return x[0] < 0.1 ? std::nan("") : 1.0; };
    for (const Method& method : methods_of_gpus) {
        const Budget budget{.evaluations = 20'000};
        const IntegrationResult a = integrate(there, Domain::unit_cube(2), method, budget),
                                b = integrate(here, Domain::unit_cube(2), method, budget);
        EXPECT_EQ(a.non_finite, b.non_finite) << method.name();
        EXPECT_EQ(a.first_non_finite_point, b.first_non_finite_point) << method.name();
        EXPECT_EQ(a.value[0], b.value[0]) << method.name();
    }
}

TEST_F(OnGpu, HugeAndTinyValuesAreScaled) {
    for (const char* factor : {"1e200", "1e-200"}) {
        const Integrand there = integrand(
            std::string("double integrand(int, const double* x) { return ") + factor + " * x[0]; }", 1);
        const IntegrationResult r =
            integrate(there, Domain::interval(0, 1), BasicMonteCarlo{}, {.evaluations = 10'000});
        EXPECT_NEAR(r.value[0] / std::atof(factor), 0.5, 0.02);
    }
}

TEST_F(OnGpu, TheCompilersMessagesAreInTheError) {
    expect_error("unknown_name", [&] {
        compiled({.text = "double integrand(int, const double*) { return unknown_name; }"}, 1);
    });
}

// An integrand that reads beyond its point ends in an error, not in a wrong value.
TEST_F(OnGpu, FaultsOfTheIntegrandAreErrors) {
    const Integrand f = integrand(
        "double integrand(int, const double* x) { return *(const double*)(size_t)(8 * (x[0] > 2)); }", 1);
    EXPECT_THROW(integrate(f, Domain::interval(0, 1), BasicMonteCarlo{}, {.evaluations = 1000}), Error);
}

} // namespace
} // namespace montelux
