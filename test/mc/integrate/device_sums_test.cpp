// Values that a device sums: the processor's bits, with what the sums do not say, and few values left to the processor.
#include "test/mc/integrate/integrate_testing.h"
#include "test/mc/integrate/on_emulated_device.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <utility>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/lane_sum.h"
#include "montelux/mc/integrate/quasi/quasi.h"
#include "montelux/mc/integrate/unit_points.h"

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
        {"rarely huge", Domain::unit_cube(2), "x[0] < 1e-5 ? 1e290 + 1e294 * x[0] : x[1]",
         [](double x, double y) { return x < 1e-5 ? 1e290 + 1e294 * x : y; }},
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

TEST_F(SumsOnEmulatedDevice, BatchesHaveTheProcessorsBits) {
    constexpr std::uint64_t count = 40 * batch_size + 77; // the last one is short
    static constexpr double floor = 1e4, most = 1.95;
    const Domain domain({{0, infinity}, {-1, 2}});
    OnDevice clamped =
        integrand("double integrand(int, const double* x) { return x[1] / (1 + x[0]); }", 2).on_device();
    std::uint64_t passed = 0;
    clamped.after.emplace_back([&passed](ValueBatch f) {
        passed += f.count();
        for (double& v : f.component(0)) v = std::min(v, most);
    });
    double largest = 0; // of f
    const Evaluator here(Integrand([&largest](std::span<const double> x) {
                             const double f = x[1] / (1 + x[0]);
                             largest = std::max(largest, f);
                             return std::min(f, most);
                         }),
                         domain);
    const Evaluator there(Integrand::compiled(clamped.function).with_device(clamped), domain);
    const auto device = DeviceValues::of(there);
    device->summarise_above(floor);
    device->draw_random(5, 0, 0, count);
    const std::uint64_t asked = passed;
    std::uint64_t summed = 0, clamps = 0, tails = 0;
    for (std::uint64_t first = 0; first < count; first += batch_size) {
        const std::uint64_t n = std::min(batch_size, count - first);
        PointBuffer u(n, 2);
        fill_random(u, 5, 0, first);
        ValueBuffer values(n, 1);
        NonFiniteCount none;
        largest = 0;
        here(u, values, none);
        const std::span<const double> g = std::as_const(values).component(0);
        const bool in_tail = std::ranges::any_of(g, [](double v) { return std::abs(v) > floor; });
        const DeviceSummary* const s = device->summary(first);
        ASSERT_EQ(s == nullptr, in_tail || largest > most) << first;
        tails += in_tail ? 1 : 0;
        clamps += largest > most ? 1 : 0;
        if (s != nullptr) {
            ++summed;
            EXPECT_EQ(s->sum, lane_sum(n, [g](std::size_t i) { return g[i]; })) << first;
            EXPECT_EQ(s->squares, lane_sum(n, [g](std::size_t i) { return g[i] * g[i]; })) << first;
            SampleMoments a{CovarianceMoments(1, false), {}}, b = a;
            a.add(*s, n);
            b.add(values);
            EXPECT_EQ(a.moments.mean(0), b.moments.mean(0)) << first;
            EXPECT_EQ(a.moments.variance(0), b.moments.variance(0)) << first;
        } else {
            ValueBuffer copied(n, 1);
            device->read(first, copied, {}, none);
            EXPECT_TRUE(std::ranges::equal(std::as_const(copied).component(0), g)) << first;
        }
    }
    // Of batches without a tail the least and the greatest value, and no others before they are read.
    EXPECT_EQ(asked, 2 * (count / batch_size + 1 - tails));
    EXPECT_GT(summed, 10u);
    EXPECT_GT(clamps, 3u);
    EXPECT_GT(tails, 3u);
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
