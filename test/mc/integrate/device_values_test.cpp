// Integrals on a device. Its emulation runs the kernels' own source on the processor, so that everything but the GPU is
// tested: points, values, sums and errors have the bits of the processor's.
#include "test/mc/integrate/device_points.h"
#include "test/mc/integrate/estimator_checks.h"
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
#include "montelux/mc/integrate/auto.h"
#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrate_log.h"
#include "montelux/mc/integrate/quasi/quasi.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/integrate/vegas/vegas.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

const Method all_methods[] = {BasicMonteCarlo{}, Quasi{}, Vegas{}, VegasSobol{}, Adaptive{}};

const std::string two_source = "void integrand(int, const double* x, int, double* y) {\n"
                               "    y[0] = x[0] * exp(-x[1]);\n"
                               "    y[1] = x[1] * x[1];\n"
                               "}\n";

TEST_F(OnEmulatedDevice, RandomPointsHaveTheProcessorsBits) {
    expect_random_points(Device::open("emulated"), 300);
}

TEST_F(OnEmulatedDevice, SobolPointsHaveTheProcessorsBits) {
    expect_sobol_points(Device::open("emulated"), 130);
}

TEST_F(OnEmulatedDevice, EstimatesHaveTheProcessorsBitsForAHundredSeeds) {
    const Integrand there = integrand(peak_source, 3), here = peak_here;
    for (const Method& method : all_methods)
        for (std::uint64_t seed = 0; seed < 100; ++seed) {
            const Budget budget{.evaluations = 6'000};
            const IntegrationResult a =
                integrate(there, Domain::unit_cube(3), method, budget, {.seed = seed});
            const IntegrationResult b = integrate(here, Domain::unit_cube(3), method, budget, {.seed = seed});
            ASSERT_TRUE(same_but_for_time(a, b)) << method.name() << ", seed " << seed << ": " << to_string(a)
                                                 << " instead of " << to_string(b);
        }
}

TEST_F(OnEmulatedDevice, ManyBlocksAgreeToRounding) {
    OnDevice small = integrand(peak_source, 2).on_device();
    small.block = 5000;
    std::size_t largest = 0;
    small.before.emplace_back([&largest](std::size_t points) { largest = std::max(largest, points); });
    const Integrand there = Integrand::compiled(small.function).with_device(small), here = peak_here;
    for (const Method& method : all_methods) {
        const Budget budget{.evaluations = 100'000};
        largest = 0;
        const IntegrationResult a = integrate(there, Domain::unit_cube(2), method, budget);
        const IntegrationResult b = integrate(here, Domain::unit_cube(2), method, budget);
        EXPECT_NEAR(a.value[0], b.value[0], 1e-13 * b.value[0]) << method.name();
        EXPECT_NEAR(a.standard_error[0], b.standard_error[0], 1e-9 * b.standard_error[0]) << method.name();
        EXPECT_EQ(a.evaluations, b.evaluations);
        EXPECT_LE(largest, small.block) << method.name();
        EXPECT_GT(largest, 0u) << method.name();
    }
}

TEST_F(OnEmulatedDevice, TheSamePointsTrainTheMapInManyBlocks) {
    OnDevice small = integrand(peak_source, 2).on_device();
    small.block = 20'000; // less than a batch of each replicate
    const Integrand there = Integrand::compiled(small.function).with_device(small), here = peak_here;
    // A part of the first iteration's points trains the map of the second.
    const VegasSobol method{{.replicates = 128}};
    const Budget budget{.evaluations = 1'300'000};
    const IntegrationResult a = integrate(there, Domain::unit_cube(2), method, budget);
    const IntegrationResult b = integrate(here, Domain::unit_cube(2), method, budget);
    ASSERT_EQ(a.history.size(), b.history.size());
    EXPECT_NEAR(a.value[0], b.value[0], 1e-13 * b.value[0]);
    EXPECT_NEAR(a.standard_error[0], b.standard_error[0], 1e-9 * b.standard_error[0]);
}

TEST_F(OnEmulatedDevice, ABoxOfManyPointsIsDrawnPieceByPiece) {
    // Without a map and with beta = 1 a sixteenth of all points is in the box of the peak.
    OnDevice small = integrand("double integrand(int, const double* x) {\n"
                               "    return x[0] < 0.01 && x[1] < 0.01 ? 1 + x[0] : 0.001 * x[1];\n"
                               "}\n",
                               2)
                         .on_device();
    small.block = 2000; // a task has 16384 points at least
    std::size_t largest = 0;
    small.before.emplace_back([&largest](std::size_t points) { largest = std::max(largest, points); });
    const Integrand there = Integrand::compiled(small.function).with_device(small);
    const Integrand here = [](std::span<const double> x) {
        return x[0] < 0.01 && x[1] < 0.01 ? 1 + x[0] : 0.001 * x[1];
    };
    const Vegas method{.alpha = 0, .beta = 1};
    const IntegrationResult a = integrate(there, Domain::unit_cube(2), method, {.evaluations = 400'000});
    const IntegrationResult b = integrate(here, Domain::unit_cube(2), method, {.evaluations = 400'000});
    EXPECT_NEAR(a.value[0], b.value[0], 1e-13 * b.value[0]);
    EXPECT_NEAR(a.standard_error[0], b.standard_error[0], 1e-9 * b.standard_error[0]);
    EXPECT_LE(largest, small.block);
}

TEST_F(OnEmulatedDevice, BlocksOfManyComponentsAreBoundedInBytes) {
    const auto block_of = [](int components) {
        const Integrand f = integrand(
            "void integrand(int, const double* x, int m, double* y) { y[m - 1] = *x; }", 1, components);
        return DeviceValues::of(Evaluator(f, Domain::unit_cube(1)))->block_size();
    };
    EXPECT_EQ(block_of(2), 1u << 20);
    EXPECT_LE(block_of(1000) * 1000 * sizeof(double), 1u << 27);
    EXPECT_GE(block_of(1000), 1u << 12);
}

TEST_F(OnEmulatedDevice, InfiniteRangesHaveTheProcessorsBits) {
    const double inf = infinity;
    const Domain domain({{-inf, inf}, {0, inf}, {-inf, 2}, {-1, 3}});
    const Integrand there = integrand("double integrand(int, const double* x) {\n"
                                      "    return exp(-x[0] * x[0] - x[1] + (x[2] - 2) + 0.1 * x[3]);\n"
                                      "}\n",
                                      4);
    const Integrand here = [](std::span<const double> x) {
        return std::exp(-x[0] * x[0] - x[1] + (x[2] - 2) + 0.1 * x[3]);
    };
    for (const Method& method : all_methods) {
        const Budget budget{.evaluations = 50'000};
        EXPECT_TRUE(same_but_for_time(integrate(there, domain, method, budget),
                                      integrate(here, domain, method, budget)))
            << method.name();
    }
}

TEST_F(OnEmulatedDevice, VectorsAndParameters) {
    const KnownIntegral cpu = two_components();
    const Integrand there = integrand(two_source, 2, 2);
    for (const Method& method : all_methods) {
        const Budget budget{.evaluations = 30'000};
        EXPECT_TRUE(same_but_for_time(integrate(there, cpu.domain, method, budget),
                                      integrate(cpu.f, cpu.domain, method, budget)))
            << method.name();
    }
    const Integrand with_parameters =
        integrand("double integrand(int, const double* x, const double* parameters) {\n"
                  "    return parameters[0] * x[0] + parameters[1];\n"
                  "}\n",
                  1, 0, {4, 0.5});
    EXPECT_NEAR(integrate(with_parameters, Domain::interval(0, 1), Quasi{}, {.evaluations = 4096}).value[0],
                2.5, 1e-4);
}

TEST_F(OnEmulatedDevice, Logarithms) {
    const Integrand there =
        integrand("double integrand(int, const double* x) { return -5000 - x[0] * x[0] / 2; }", 1);
    const Integrand here = [](double x) { return -5000 - x * x / 2; };
    const Domain line = Domain::interval(-infinity, infinity);
    for (const Method& method : all_methods) {
        const LogIntegrationResult a = integrate_log(there, line, method, {.evaluations = 30'000});
        const LogIntegrationResult b = integrate_log(here, line, method, {.evaluations = 30'000});
        EXPECT_EQ(a.log_value, b.log_value) << method.name();
        EXPECT_EQ(a.log_error, b.log_error) << method.name();
    }
}

TEST_F(OnEmulatedDevice, HugeAndTinyValuesAreScaled) {
    for (const char* factor : {"1e200", "1e-200"}) {
        const Integrand there = integrand(
            std::string("double integrand(int, const double* x) { return ") + factor + " * x[0]; }", 1);
        const IntegrationResult r =
            integrate(there, Domain::interval(0, 1), BasicMonteCarlo{}, {.evaluations = 10'000});
        EXPECT_NEAR(r.value[0] / std::atof(factor), 0.5, 0.02);
        EXPECT_GT(r.standard_error[0], 0);
    }
}

TEST_F(OnEmulatedDevice, ValuesThatAreNotFiniteAreCountedAndLocated) {
    const Integrand there =
        integrand("double integrand(int, const double* x) { return x[0] < 0.1 ? nan(\"\") : 1; }", 2);
    const Integrand here = [](std::span<const double> x) { return x[0] < 0.1 ? std::nan("") : 1.0; };
    const Domain domain({{-0.5, 1}, {0, 1}});
    for (const Method& method : all_methods) {
        const Budget budget{.evaluations = 20'000};
        const IntegrationResult a = integrate(there, domain, method, budget),
                                b = integrate(here, domain, method, budget);
        EXPECT_GT(a.non_finite, 1000u) << method.name();
        EXPECT_TRUE(same_but_for_time(a, b)) << method.name();
        EXPECT_EQ(a.first_non_finite_point, b.first_non_finite_point) << method.name();
        expect_error("the integrand is nan at (", [&] {
            integrate(there, domain, method, budget, {.non_finite = NonFinitePolicy::throw_error});
        });
    }
}

TEST_F(OnEmulatedDevice, SameBitsForAnyThreadsAndAfterAResume) {
    const KnownIntegral problem{integrand(two_source, 2, 2), two_components().domain, two_components().truth};
    for (const Method& method : all_methods) {
        expect_same_bits_for_any_threads(problem, method, 20'000);
        expect_same_bits_after_resume(problem, method, 20'000);
    }
}

TEST_F(OnEmulatedDevice, StopsInTime) {
    const Integrand slow = integrand("double integrand(int, const double* x) {\n"
                                     "    double s = x[0];\n"
                                     "    for (int i = 0; i < 1000; ++i) s = s * 0.999 + 1e-4;\n"
                                     "    return s;\n"
                                     "}\n",
                                     1);
    const IntegrationResult r = integrate(slow, Domain::interval(0, 1), BasicMonteCarlo{},
                                          {.time = std::chrono::duration<double>(0.2)});
    EXPECT_EQ(r.stop, StopReason::time);
    EXPECT_GT(r.evaluations, 0u);
}

TEST_F(OnEmulatedDevice, WhatADeviceCannotDoIsSaid) {
    const Integrand f = integrand(peak_source, 2);
    const Budget budget{.evaluations = 1000};
    expect_error(
        "the method 'auto' does not run on a device; expected adaptive, vegas, vegas_sobol, quasi or basic",
        [&] { integrate(f, Domain::unit_cube(2), Auto{}, budget); });
    expect_error("points of a simplex", [&] { integrate(f, Domain::simplex(2), Adaptive{}, budget); });
    expect_error("points of a ball in 2 dimensions are not drawn on a device", [&] {
        integrate(f, Domain::ball({0, 0}), BasicMonteCarlo{}, budget);
    });
    expect_error("a device draws scrambled Sobol' points only, not 'halton'",
                 [&] { integrate(f, Domain::unit_cube(2), Quasi{.points = PointSetKind::halton}, budget); });
    expect_error("the integrand takes 2 numbers, but the domain",
                 [&] { integrate(f, Domain::unit_cube(3), BasicMonteCarlo{}, budget); });
    expect_error("there is no device 'cudo' (did you mean 'cuda'?)", [] { Device::open("cudo"); });
}

TEST_F(OnEmulatedDevice, SourcesMayDefineFunctionsOfCuda) {
    const auto f = compiled({.text = "static double normcdfinv(double p) { return 2 * p; }\n"
                                     "double integrand(int, const double* x) { return normcdfinv(x[0]); }\n"},
                            1);
    f->prepare_mixtures();
    EXPECT_NEAR(
        integrate(Integrand::compiled(f), Domain::interval(0, 1), Quasi{}, {.evaluations = 4096}).value[0], 1,
        1e-4);
}

TEST_F(OnEmulatedDevice, TheCompilersMessagesAreInTheError) {
    const auto compile = [](const std::string& text, const std::string& function = "integrand") {
        compiled({.text = text, .file = "bad.cu", .function = function}, 1);
    };
    expect_error("bad.cu:2",
                 [&] { compile("double integrand(int, const double* x) {\n return unknown_name; }"); });
    expect_error("unknown_name",
                 [&] { compile("double integrand(int, const double*) { return unknown_name; }"); });
    expect_error("expected the function `double other(int n, const double *x)`",
                 [&] { compile("double integrand(int, const double* x) { return x[0]; }", "other"); });
    expect_error("expected the function `double integrand(int n, const double *x)`",
                 [&] { compile("double integrand(double x) { return x; }"); });
    expect_error("bad.cu: '' is not the name of a function", [&] { compile("", ""); });
}

} // namespace
} // namespace montelux
