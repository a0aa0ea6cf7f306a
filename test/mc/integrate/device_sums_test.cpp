// Values that a device sums: the processor's bits, with what the sums do not say, and few values left to the processor.
#include "test/mc/integrate/integrate_testing.h"
#include "test/mc/integrate/on_emulated_device.h"
#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <utility>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/quasi/quasi.h"

namespace montelux {
namespace {

class SumsOnEmulatedDevice : public OnEmulatedDevice {};

constexpr std::uint64_t summed_evaluations = 2'000'000; // the tail is full after a million

struct Summed {
    const char* name;
    Domain domain;
    const char* there;
    double (*here)(double x, double y);
};

TEST_F(SumsOnEmulatedDevice, EstimatesHaveTheProcessorsBits) {
    const Summed all[] = {
        {"xy", Domain::unit_cube(2), "x[0] * x[1]", [](double x, double y) { return x * y; }},
        {"box", Domain({{-1, 2}, {0, 0.7}}), "x[0] * exp(x[1])",
         [](double x, double y) { return x * std::exp(y); }},
        {"infinite", Domain({{0, infinity}, {0, 1}}), "exp(-x[0]) * x[1]",
         [](double x, double y) { return std::exp(-x) * y; }},
        {"heavy", Domain::unit_cube(2), "pow(x[0], -0.6) + x[1]",
         [](double x, double y) { return std::pow(x, -0.6) + y; }},
        {"rarely nan", Domain({{0, 2}, {0, 1}}), "x[0] < 1e-5 ? nan(\"\") : x[1]",
         [](double x, double y) { return x < 1e-5 ? std::nan("") : y; }},
        {"rarely huge", Domain::unit_cube(2), "x[0] < 1e-5 ? 1e290 : x[1]",
         [](double x, double y) { return x < 1e-5 ? 1e290 : y; }},
        {"scaled", Domain::unit_cube(2), "1e-200 * (x[0] + x[1])",
         [](double x, double y) { return 1e-200 * (x + y); }}};
    for (const Summed& f : all) {
        const Integrand there =
            integrand(std::string("double integrand(int, const double* x) { return ") + f.there + "; }", 2);
        const Integrand here = [&f](std::span<const double> x) { return f.here(x[0], x[1]); };
        for (const Method& method : {Method(BasicMonteCarlo{}), Method(Quasi{})}) {
            const IntegrationResult a =
                integrate(there, f.domain, method, {.evaluations = summed_evaluations});
            const IntegrationResult b =
                integrate(here, f.domain, method, {.evaluations = summed_evaluations});
            EXPECT_TRUE(same_but_for_time(a, b)) << f.name << " by " << method.name() << ": " << to_string(a)
                                                 << " instead of " << to_string(b);
            EXPECT_EQ(a.first_non_finite_point, b.first_non_finite_point) << f.name;
        }
    }
}

TEST_F(SumsOnEmulatedDevice, TheProcessorSumsFewValues) {
    OnDevice counted =
        integrand("double integrand(int, const double* x) { return exp(-x[0]) * x[1]; }", 2).on_device();
    std::atomic<std::uint64_t> values{0};
    counted.after.emplace_back([&values](ValueBatch g) {
        if (g.count() > 2) values += g.count(); // not the extreme values of a batch
    });
    const Integrand there = Integrand::compiled(counted.function).with_device(counted);
    for (const Method& method : {Method(BasicMonteCarlo{}), Method(Quasi{})}) {
        values = 0;
        integrate(there, Domain::unit_cube(2), method, {.evaluations = 1 << 23});
        EXPECT_GT(values.load(), 100'000u) << method.name();
        EXPECT_LT(static_cast<double>(values), 0.7 * (1 << 23)) << method.name();
    }
}

} // namespace
} // namespace montelux
