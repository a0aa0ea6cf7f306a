// Parallel loops keyed by index, on oneTBB; reductions are bit-identical for any number of threads.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "montelux/mc/math/function_ref.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

// More threads would only slow each other down.
inline constexpr int most_threads = 4096;

// While it lives, loops of the whole process use at most `threads` threads; 0 means one per processor.
// Limits nest: the smallest one holds. A number above the processors' changes nothing.
class ThreadLimit {
  public:
    // Throws Error unless 0 <= threads <= most_threads.
    explicit ThreadLimit(int threads);
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;
    ~ThreadLimit();

  private:
    struct Control;
    std::unique_ptr<Control> control_;
};

// Number of threads that a loop started now may use.
int thread_count();

void run_with_threads(int threads, FunctionRef<void()> f);

// Runs f with loops on exactly this many threads, more than there are processors too; 0 leaves the number as
// it is.
template <typename F>
auto with_threads(int threads, const F& f) {
    using Result = std::invoke_result_t<const F&>;
    if constexpr (std::is_void_v<Result>) {
        run_with_threads(threads, f);
    } else {
        std::optional<Result> result;
        run_with_threads(threads, [&] { result.emplace(f()); });
        return std::move(*result);
    }
}

// Calls range(begin, end) for disjoint ranges that make up [0, count), each at least `grain` long where it can be;
// false as soon as a range returned false. Exceptions as parallel_for.
bool parallel_ranges(std::int64_t count, std::int64_t grain,
                     FunctionRef<bool(std::int64_t, std::int64_t)> range);

// Calls f; a thread that waits in it for a loop takes no iterations of outer loops meanwhile.
void isolate_loops(FunctionRef<void()> f);

// Calls body(i) once for each i in [0, count), in no particular order. `grain` is the smallest run of
// indices that one thread takes at a time: raise it when the body is tiny. The first exception of a body
// stops the loop and is rethrown here. Returns false when `cancel` stopped the loop early.
template <typename Body>
requires std::invocable<const Body&, std::int64_t>
bool parallel_for(std::int64_t count, const Body& body, const CancelFlag* cancel = nullptr,
                  std::int64_t grain = 1) {
    return parallel_ranges(count, grain, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i != end; ++i) {
            if (cancel && cancel->requested()) return false;
            body(i);
        }
        return true;
    });
}

// parallel_for for the body of another loop that holds scratch memory or locks.
template <typename Body>
bool parallel_for_isolated(std::int64_t count, const Body& body, const CancelFlag* cancel = nullptr) {
    bool complete = false;
    isolate_loops([&] { complete = parallel_for(count, body, cancel); });
    return complete;
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
