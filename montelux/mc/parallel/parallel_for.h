// Parallel loops keyed by index, on oneTBB; reductions are bit-identical for any number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux {

// More threads would only slow each other down.
inline constexpr int most_threads = 4096;

// While it lives, loops of the whole process use at most `threads` threads; 0 means one per processor.
// Limits nest: the smallest one holds. A number above the processors' changes nothing.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads) {
        if (threads < 0 || threads > most_threads)
            throw Error("threads", "expected a number from 0 to " + std::to_string(most_threads) + ", got " +
                                       std::to_string(threads));
        if (threads > 0)
            control_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    }
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    std::optional<tbb::global_control> control_;
};

// Number of threads that a loop started now may use.
inline int thread_count() {
    auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min(static_cast<int>(std::min<std::size_t>(allowed, 1u << 20)),
                    tbb::this_task_arena::max_concurrency());
}

// Runs f with loops on exactly this many threads, more than there are processors too; 0 leaves the number as
// it is.
template <typename F>
decltype(auto) with_threads(int threads, const F& f) {
    ThreadLimit limit(threads);
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    return arena.execute(f);
}

// Asked between iterations; may be requested from any thread or from a signal handler.
class CancelFlag {
  public:
    void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
    void reset() noexcept { requested_.store(false, std::memory_order_relaxed); }
    bool requested() const noexcept { return requested_.load(std::memory_order_relaxed); }

  private:
    std::atomic<bool> requested_{false};
    static_assert(std::atomic<bool>::is_always_lock_free);
};

// Calls body(i) once for each i in [0, count), in no particular order. `grain` is the smallest run of
// indices that one thread takes at a time: raise it when the body is tiny. The first exception of a body
// stops the loop and is rethrown here. Returns false when `cancel` stopped the loop early.
template <typename Body>
requires std::invocable<const Body&, std::int64_t>
bool parallel_for(std::int64_t count, const Body& body, const CancelFlag* cancel = nullptr,
                  std::int64_t grain = 1) {
    if (count <= 0) return true;
    std::atomic<bool> complete{true};
    // Isolated: a failure or cancellation here must not cancel a loop around this one, nor the reverse.
    tbb::task_group_context context(tbb::task_group_context::isolated);
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, count,
                                         static_cast<std::size_t>(std::max<std::int64_t>(1, grain))),
        [&](const tbb::blocked_range<std::int64_t>& range) {
            for (std::int64_t i = range.begin(); i != range.end(); ++i) {
                if (cancel && cancel->requested()) {
                    complete.store(false, std::memory_order_relaxed);
                    return;
                }
                body(i);
            }
        },
        context);
    return complete.load();
}

// parallel_for for the body of another loop that holds scratch memory or locks: a thread that waits for the
// inner loop takes no iterations of outer ones meanwhile.
template <typename Body>
bool parallel_for_isolated(std::int64_t count, const Body& body, const CancelFlag* cancel = nullptr) {
    return tbb::this_task_arena::isolate([&] { return parallel_for(count, body, cancel); });
}

// combine(...combine(combine(map(0), map(1)), map(2))..., map(count - 1)), grouped into runs whose lengths
// depend on `count` alone, so rounding does not depend on the threads. `combine` takes two values and
// returns one; it need not commute. A count of zero gives a value-initialised result; a loop that
// `cancel` stopped early gives no result.
template <typename Map, typename Combine, typename T = std::invoke_result_t<const Map&, std::int64_t>>
std::optional<T> parallel_reduce_ordered(std::int64_t count, const Map& map, const Combine& combine,
                                         const CancelFlag* cancel) {
    if (count <= 0) return T{};
    constexpr std::int64_t max_runs = 1024;
    std::int64_t length = (count + max_runs - 1) / max_runs;
    std::int64_t runs = (count + length - 1) / length;
    std::vector<std::optional<T>> partial(static_cast<std::size_t>(runs));
    bool complete = parallel_for(
        runs,
        [&](std::int64_t run) {
            std::int64_t begin = run * length, end = std::min(count, begin + length);
            T total = map(begin);
            for (std::int64_t i = begin + 1; i < end; ++i) {
                if (cancel && cancel->requested()) return;
                total = combine(std::move(total), map(i));
            }
            partial[static_cast<std::size_t>(run)].emplace(std::move(total));
        },
        cancel);
    if (!complete) return std::nullopt;
    for (const auto& p : partial)
        if (!p) return std::nullopt;
    T total = std::move(*partial.front());
    for (std::size_t i = 1; i < partial.size(); ++i)
        total = combine(std::move(total), std::move(*partial[i]));
    return total;
}
template <typename Map, typename Combine, typename T = std::invoke_result_t<const Map&, std::int64_t>>
T parallel_reduce_ordered(std::int64_t count, const Map& map, const Combine& combine) {
    return *parallel_reduce_ordered(count, map, combine, nullptr);
}

} // namespace montelux
