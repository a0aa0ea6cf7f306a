// Slow integrands: their points are evaluated on all threads, exactly as often as one thread would.
#include "test/mc/integrate/integrate_testing.h"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "montelux/mc/integrate/interruptible.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

// Counts calls, and how many ran at the same time at most.
struct Calls {
    // So many calls wait up to 50 ms each until two run at the same time: on a busy machine a thread may take seconds to
    // leave the loop of an earlier test.
    std::uint64_t patient = 0;
    std::atomic<int> running{0}, most{0};
    std::atomic<std::uint64_t> count{0};

    template <typename F>
    auto during(const F& f) {
        const int now = ++running;
        for (int m = most; now > m && !most.compare_exchange_weak(m, now);) {
        }
        if (count++ < patient)
            for (int ms = 0; ms < 50 && most < 2; ++ms)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const auto y = f();
        --running;
        return y;
    }
};

double kinked(std::span<const double> x) { return std::abs(x[0] - 0.3) * (1 + x[1]); }

double sleepy(std::span<const double> x) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    return kinked(x);
}

class SlowIntegrand : public testing::TestWithParam<const char*> {};

TEST_P(SlowIntegrand, PointsAreEvaluatedAtTheSameTime) {
    const Method method = Method::named(GetParam());
    auto run = [&](Calls& calls, int threads) {
        auto f = [&](std::span<const double> x) { return calls.during([&] { return sleepy(x); }); };
        return integrate(f, Domain::unit_cube(2), method, {.evaluations = 2500}, {.threads = threads});
    };
    Calls alone, together{.patient = 1000};
    const IntegrationResult one = run(alone, 1), two = run(together, 2);
    EXPECT_EQ(alone.most, 1);
    EXPECT_EQ(together.most, 2);
    EXPECT_EQ(alone.count, one.evaluations);
    EXPECT_EQ(together.count, two.evaluations);
    EXPECT_TRUE(same_but_for_time(one, two));
    const auto fast = integrate(kinked, Domain::unit_cube(2), method, {.evaluations = 2500}, {.threads = 2});
    EXPECT_TRUE(same_but_for_time(one, fast));
}
INSTANTIATE_TEST_SUITE_P(Methods, SlowIntegrand,
                         testing::Values("basic", "vegas", "quasi", "cubature", "adaptive"),
                         [](const auto& of) { return std::string(of.param); });

// A batch of one estimator's task, on its own.
struct Batch {
    PointBuffer x;
    ValueBuffer y;
    explicit Batch(std::size_t points) : x(points, 1), y(points, 1) {
        for (std::size_t i = 0; i < points; ++i) x(i, 0) = static_cast<double>(i);
    }
};

TEST(Interruptible, EachPointOfASlowBatchIsEvaluatedOnce) {
    for (const std::size_t points : {1u, 7u, 8u, 9u, 300u, 1001u}) {
        for (const int microseconds : {30, 300, 3000}) {
            if (points * static_cast<std::size_t>(microseconds) > 400'000) continue;
            Calls calls;
            const Integrand f([&](double x) {
                return calls.during([&] {
                    std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
                    return x + 1;
                });
            });
            Interruption interruption(nullptr);
            const Integrand slow = interruptible(f, interruption);
            Batch batch(points);
            with_threads(3, [&] {
                for (int again = 0; again < 2; ++again) slow(batch.x, batch.y);
            });
            for (std::size_t i = 0; i < points; ++i) ASSERT_EQ(batch.y(i, 0), static_cast<double>(i) + 1);
            EXPECT_EQ(calls.count, 2 * points);
            EXPECT_EQ(interruption.evaluations(), 2 * points);
        }
    }
}

TEST(Interruptible, SlicesAreMultiplesOfEight) {
    std::atomic<int> remainders{0}, slices{0};
    const Integrand f = Integrand::batch([&](const PointBatch& x, ValueBatch y) {
        ++slices;
        if (x.count() % 8 != 0) ++remainders;
        std::this_thread::sleep_for(std::chrono::microseconds(30 * x.count()));
        for (std::size_t i = 0; i < x.count(); ++i) y(i, 0) = 1;
    });
    Interruption interruption(nullptr);
    const Integrand slow = interruptible(f, interruption);
    Batch batch(4096);
    with_threads(3, [&] { slow(batch.x, batch.y); });
    EXPECT_EQ(remainders, 0);
    EXPECT_GT(slices, 8);
}

TEST(Interruptible, ExceptionsOfSlowIntegrandsPassThrough) {
    std::atomic<int> calls{0};
    const Integrand f([&](double x) {
        ++calls;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (x >= 100) throw std::out_of_range("a hundred");
        return x;
    });
    Interruption interruption(nullptr);
    const Integrand slow = interruptible(f, interruption);
    Batch batch(4096);
    EXPECT_THROW(with_threads(2, [&] { slow(batch.x, batch.y); }), std::out_of_range);
    EXPECT_LT(calls, 400); // what had begun ends, and nothing else begins
}

TEST(Interruptible, SlowBatchesAreInterrupted) {
    CancelFlag cancel;
    Interruption interruption(&cancel);
    std::atomic<int> calls{0};
    const Integrand f([&](double x) {
        if (++calls == 100) cancel.request();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return x;
    });
    const Integrand slow = interruptible(f, interruption);
    Batch batch(4096);
    EXPECT_THROW(with_threads(2, [&] { slow(batch.x, batch.y); }), IntegrandInterrupted);
    EXPECT_LT(calls, 400);
    cancel.reset();
    calls = 1000;
    interruption.set_deadline(Interruption::Clock::now() + std::chrono::milliseconds(60));
    EXPECT_THROW(with_threads(2, [&] { slow(batch.x, batch.y); }), IntegrandInterrupted);
    EXPECT_LT(calls, 1400);
}

// An integrand that holds a lock while it works, as Python's do, and integrates itself.
TEST(Interruptible, SlowIntegrandsWithALockOfTheirOwn) {
    std::mutex mutex;
    auto inner = [](double x) { return x; };
    auto f = [&](double x) {
        {
            const std::lock_guard lock(mutex);
            std::this_thread::sleep_for(std::chrono::microseconds(100));
        }
        return x * integrate(inner, Domain::interval(0, 1), basic, {.evaluations = 64}).evaluations;
    };
    const auto r = integrate(f, Domain::interval(0, 1), basic, {.evaluations = 1000}, {.threads = 4});
    EXPECT_EQ(r.evaluations, 1000u);
    EXPECT_LT(std::abs(r.estimate().z_score(32)), 5.5);
}

} // namespace
} // namespace montelux
