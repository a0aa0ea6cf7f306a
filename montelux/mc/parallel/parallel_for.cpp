#include "montelux/mc/parallel/parallel_for.h"

#include <atomic>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux {

struct ThreadLimit::Control {
    explicit Control(int threads)
        : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {}
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
    if (threads < 0 || threads > most_threads)
        throw Error("threads", "expected a number from 0 to " + std::to_string(most_threads) + ", got " +
                                   std::to_string(threads));
    if (threads > 0) control_ = std::make_unique<Control>(threads);
}

ThreadLimit::~ThreadLimit() = default;

int thread_count() {
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min(static_cast<int>(std::min<std::size_t>(allowed, 1u << 20)),
                    tbb::this_task_arena::max_concurrency());
}

void run_with_threads(int threads, FunctionRef<void()> f) {
    const ThreadLimit limit(threads);
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    arena.execute(f);
}

bool parallel_ranges(std::int64_t count, std::int64_t grain,
                     FunctionRef<bool(std::int64_t, std::int64_t)> range) {
    if (count <= 0) return true;
    std::atomic<bool> complete{true};
    // Isolated: a failure or cancellation here must not cancel a loop around this one, nor the reverse.
    tbb::task_group_context context(tbb::task_group_context::isolated);
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, count,
                                         static_cast<std::size_t>(std::max<std::int64_t>(1, grain))),
        [&](const tbb::blocked_range<std::int64_t>& part) {
            if (!range(part.begin(), part.end())) complete.store(false, std::memory_order_relaxed);
        },
        context);
    return complete.load();
}

void isolate_loops(FunctionRef<void()> f) { tbb::this_task_arena::isolate(f); }

} // namespace montelux
