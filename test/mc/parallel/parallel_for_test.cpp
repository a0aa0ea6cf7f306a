#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

TEST(ParallelFor, EveryIndexOnce) {
    std::vector<std::atomic<int>> seen(10007);
    EXPECT_TRUE(parallel_for(10007, [&](std::int64_t i) { ++seen[static_cast<std::size_t>(i)]; }));
    for (const auto& s : seen) ASSERT_EQ(s.load(), 1);
    EXPECT_TRUE(parallel_for(0, [](std::int64_t) { FAIL(); }));
}

TEST(ParallelFor, ExceptionsPropagateWithTheirType) {
    auto body = [](std::int64_t i) {
        if (i == 500) throw std::out_of_range("five hundred");
    };
    try {
        parallel_for(1000, body);
        FAIL();
    } catch (const std::out_of_range& e) {
        EXPECT_STREQ(e.what(), "five hundred");
    }
    // The same from a loop within a loop; the outer one is stopped by it too.
    EXPECT_THROW(parallel_for(4, [&](std::int64_t) { parallel_for(1000, body); }), std::out_of_range);
    // An exception that is caught inside leaves the outer loop whole.
    std::atomic<int> done{0};
    EXPECT_TRUE(parallel_for(16, [&](std::int64_t) {
        try {
            parallel_for(1000, body);
        } catch (const std::out_of_range&) {
        }
        ++done;
    }));
    EXPECT_EQ(done.load(), 16);
}

TEST(ParallelFor, CancelStopsEarlyAndSaysSo) {
    CancelFlag cancel;
    std::atomic<std::int64_t> done{0};
    bool complete = parallel_for(
        1000000,
        [&](std::int64_t) {
            if (++done == 100) cancel.request();
        },
        &cancel);
    EXPECT_FALSE(complete);
    EXPECT_LT(done.load(), 1000000);
    auto sum = parallel_reduce_ordered(
        1000, [](std::int64_t i) { return i; }, [](std::int64_t a, std::int64_t b) { return a + b; },
        &cancel);
    EXPECT_FALSE(sum);
    cancel.reset();
    sum = parallel_reduce_ordered(
        1000, [](std::int64_t i) { return i; }, [](std::int64_t a, std::int64_t b) { return a + b; },
        &cancel);
    EXPECT_EQ(sum, 499500);
}

TEST(ParallelReduceOrdered, BitIdenticalForAnyNumberOfThreads) {
    // Terms of very different size, so that any other order of summation shows.
    auto term = [](std::int64_t i) {
        return std::sin(static_cast<double>(i)) * std::exp(static_cast<double>(i % 60));
    };
    auto plus = [](double a, double b) { return a + b; };
    auto sum = [&] { return parallel_reduce_ordered(300000, term, plus); };
    double first = sum();
    for (int threads : {1, 2, 3, 0}) {
        ThreadLimit limit(threads);
        for (int repeat = 0; repeat < 3; ++repeat) ASSERT_EQ(sum(), first) << threads;
    }
    // More threads than a small machine has processors.
    for (int threads : {1, 2, 5}) ASSERT_EQ(with_threads(threads, sum), first) << threads;
    // The other order does show.
    double backwards = parallel_reduce_ordered(
        300000, [&](std::int64_t i) { return term(299999 - i); }, plus);
    EXPECT_NE(backwards, first);
}

// On one thread, a request at the last value but one leaves one value out.
TEST(ParallelReduceOrdered, CancelledInItsLastRunGivesNoResult) {
    constexpr std::int64_t count = 2048;
    const ThreadLimit one(1);
    for (const std::int64_t last : {count - 1, count}) {
        CancelFlag cancel;
        std::int64_t mapped = 0;
        const auto sum = parallel_reduce_ordered(
            count,
            [&](std::int64_t i) {
                if (++mapped == last) cancel.request();
                return i;
            },
            [](std::int64_t a, std::int64_t b) { return a + b; }, &cancel);
        EXPECT_EQ(mapped, last);
        // Nothing is missing when the last value is there.
        EXPECT_EQ(sum.has_value(), last == count);
    }
}

TEST(ParallelReduceOrdered, KeepsTheOrderOfACombinationThatDoesNotCommute) {
    auto digits = parallel_reduce_ordered(
        5000, [](std::int64_t i) { return std::to_string(i) + ","; },
        [](const std::string& a, const std::string& b) { return a + b; });
    std::string expected;
    for (int i = 0; i < 5000; ++i) expected += std::to_string(i) + ",";
    EXPECT_EQ(digits, expected);
    EXPECT_EQ(parallel_reduce_ordered(
                  0, [](std::int64_t) { return 7; }, [](int a, int b) { return a + b; }),
              0);
}

TEST(ThreadLimit, LimitsAndRestores) {
    int before = thread_count();
    {
        ThreadLimit one(1);
        EXPECT_EQ(thread_count(), 1);
        ThreadLimit more(64); // the smallest limit holds
        EXPECT_EQ(thread_count(), 1);
        auto self = std::this_thread::get_id();
        parallel_for(1000, [&](std::int64_t) { EXPECT_EQ(std::this_thread::get_id(), self); });
    }
    EXPECT_EQ(thread_count(), before);
    EXPECT_THROW(ThreadLimit(-1), Error);
    EXPECT_THROW(ThreadLimit(most_threads + 1), Error);
}

} // namespace
} // namespace montelux
