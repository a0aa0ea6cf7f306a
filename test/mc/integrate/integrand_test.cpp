// The forms in which integrands are written: they agree, and vectors know their covariance.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <mutex>
#include <numeric>
#include <thread>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/integrand.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/interruptible.h"

namespace montelux {
namespace {

const Method basic = BasicMonteCarlo{};

TEST(Integrand, AllFormsAgreeBitByBit) {
    auto f = [](double x) { return std::sin(3 * x) / (1 + x); };
    const std::vector<Integrand> forms{
        Integrand(f), Integrand([&](std::span<const double> x) { return f(x[0]); }),
        Integrand::vector_valued(1, [&](std::span<const double> x, std::span<double> y) { y[0] = f(x[0]); }),
        Integrand::batch([&](const PointBatch& x, ValueBatch y) {
            for (std::size_t i = 0; i < x.count(); ++i) y(i) = f(x(i, 0));
        })};
    EXPECT_EQ(forms[0].fixed_dimensions(), 1);
    EXPECT_EQ(forms[1].fixed_dimensions(), 0);
    std::vector<IntegrationResult> results;
    for (const Integrand& form : forms) {
        EXPECT_EQ(form.components(), 1);
        results.push_back(integrate(form, Domain::interval(1, 3), basic, {.evaluations = 30'000}));
    }
    for (const IntegrationResult& r : results) {
        EXPECT_EQ(r.value, results[0].value);
        EXPECT_EQ(r.standard_error, results[0].standard_error);
    }
}
TEST(Integrand, FormsOfManyVariablesAgree) {
    // More variables than the small buffer of a point has room for, too.
    for (int n : {2, 16, 17, 40}) {
        auto f = [](std::span<const double> x) {
            double product = 1;
            for (double v : x) product *= 0.5 + v;
            return product;
        };
        auto batch = Integrand::batch([&](const PointBatch& x, ValueBatch y) {
            std::fill(y.component(0).begin(), y.component(0).end(), 1.0);
            for (int d = 0; d < x.dimensions(); ++d)
                for (std::size_t i = 0; i < x.count(); ++i) y(i) *= 0.5 + x.coordinate(d)[i];
        });
        const Budget budget{.evaluations = 10'000};
        const IntegrationResult a = integrate(f, Domain::unit_cube(n), basic, budget);
        const IntegrationResult b = integrate(batch, Domain::unit_cube(n), basic, budget);
        EXPECT_EQ(a.value, b.value) << n;
        EXPECT_LT(std::abs(a.estimate().z_score(1)), 6) << n;
    }
}
TEST(Integrand, CovarianceOfAVector) {
    // x, x^2 and 1 - x over [0, 1]: covariances 1/12, 4/45 and exact opposites.
    auto f = Integrand::vector_valued(3, [](std::span<const double> x, std::span<double> y) {
        y[0] = x[0];
        y[1] = x[0] * x[0];
        y[2] = 1 - x[0];
    });
    const std::uint64_t n = 200'000;
    const IntegrationResult r = integrate(f, Domain::unit_cube(1), basic, {.evaluations = n});
    ASSERT_EQ(r.covariance.size(), 9u);
    const double exact[3][3] = {
        {1.0 / 12, 1.0 / 12, -1.0 / 12}, {1.0 / 12, 4.0 / 45, -1.0 / 12}, {-1.0 / 12, -1.0 / 12, 1.0 / 12}};
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
            // Its relative error is about sqrt(1 / n); six of them and more.
            EXPECT_NEAR(r.covariance[3 * a + b] * static_cast<double>(n), exact[a][b],
                        0.015 * std::abs(exact[a][b]));
            EXPECT_EQ(r.covariance[3 * a + b], r.covariance[3 * b + a]);
        }
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(r.standard_error[c], std::sqrt(r.covariance[4 * c]), 1e-12 * r.standard_error[c]);
    EXPECT_NEAR(r.value[0] + r.value[2], 1, 1e-12);
    const IntegrationResult lean =
        integrate(f, Domain::unit_cube(1), basic, {.evaluations = n}, {.full_covariance = false});
    EXPECT_TRUE(lean.covariance.empty());
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(lean.value[c], r.value[c], 1e-12);
        EXPECT_NEAR(lean.standard_error[c], r.standard_error[c], 1e-9 * r.standard_error[c]);
    }
}
TEST(Integrand, AnotherFunctionOfTheSameForm) {
    const Integrand one([](double x) { return x; });
    const Integrand other = one.with_function([](const PointBatch& x, ValueBatch y) {
        for (std::size_t i = 0; i < x.count(); ++i) y(i) = -x(i, 0);
    });
    EXPECT_EQ(other.fixed_dimensions(), 1);
    EXPECT_EQ(other.components(), 1);
    EXPECT_LT(integrate(other, Domain::interval(0, 1), basic, {.evaluations = 100}).value[0], 0);
}

// Values of an interruptible integrand at n points i / n.
std::vector<double> values_at(const Integrand& f, std::size_t n) {
    PointBuffer x(n, 1);
    ValueBuffer y(n, 1);
    for (std::size_t i = 0; i < n; ++i) x(i, 0) = static_cast<double>(i) / static_cast<double>(n);
    f(x, y);
    return {y.component().begin(), y.component().end()};
}

TEST(Interruptible, ValuesAreThoseOfTheFunction) {
    auto f = [](double x) { return std::exp(-x); };
    for (std::size_t n : {1u, 7u, 8u, 9u, 100u, 1024u, 5000u}) {
        Interruption interruption(nullptr);
        const Integrand wrapped = interruptible(f, interruption);
        for (int again = 0; again < 3; ++again) EXPECT_EQ(values_at(wrapped, n), values_at(f, n)) << n;
        EXPECT_EQ(interruption.evaluations(), 3 * n);
        EXPECT_EQ(wrapped.fixed_dimensions(), 1);
    }
}
TEST(Interruptible, SlowPointsComeInShortSlices) {
    std::mutex mutex; // slices of slow points are evaluated in parallel
    std::vector<std::size_t> slices;
    auto slow = Integrand::batch([&](const PointBatch& x, ValueBatch y) {
        {
            const std::lock_guard lock(mutex);
            slices.push_back(x.count());
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(x.count()));
        for (std::size_t i = 0; i < x.count(); ++i) y(i) = x(i, 0);
    });
    Interruption interruption(nullptr);
    values_at(interruptible(slow, interruption), 200);
    EXPECT_GE(slices.size(), 8u);
    EXPECT_EQ(std::accumulate(slices.begin(), slices.end(), std::size_t{0}), 200u);
    for (std::size_t slice : slices) EXPECT_LE(slice, 40u);
    auto in_no_eights = [](std::size_t slice) { return slice > 8 && slice % 8 != 0; };
    EXPECT_LE(std::ranges::count_if(slices, in_no_eights), 1) << "but the last slice of the batch";
    std::vector<std::size_t> fast_slices;
    auto fast = Integrand::batch([&](const PointBatch& x, ValueBatch) { fast_slices.push_back(x.count()); });
    Interruption other(nullptr);
    const Integrand wrapped = interruptible(fast, other);
    for (int i = 0; i < 10; ++i) values_at(wrapped, 4096);
    EXPECT_EQ(fast_slices.back(), 4096u);
}
TEST(Interruptible, StopsByFlagAndByTime) {
    auto f = [](double x) { return x; };
    CancelFlag cancel;
    Interruption interruption(&cancel);
    const Integrand wrapped = interruptible(f, interruption);
    EXPECT_NO_THROW(values_at(wrapped, 10));
    interruption.set_deadline(Interruption::Clock::now());
    EXPECT_THROW(values_at(wrapped, 10), IntegrandInterrupted);
    EXPECT_TRUE(interruption.late());
    interruption.clear_deadline();
    EXPECT_NO_THROW(values_at(wrapped, 10));
    cancel.request();
    EXPECT_THROW(values_at(wrapped, 10), IntegrandInterrupted);
    EXPECT_EQ(interruption.evaluations(), 20u);
}

} // namespace
} // namespace montelux
