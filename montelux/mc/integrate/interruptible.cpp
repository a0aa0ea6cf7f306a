#include "montelux/mc/integrate/interruptible.h"

#include <algorithm>

namespace montelux {
namespace {

constexpr double slice_seconds = 0.02;
// From here on a slice holds any batch, and its time is measured on large batches alone.
constexpr std::size_t fast = 4096, worth_timing = 256;

} // namespace

void Interruption::evaluate(const Integrand& f, const PointBatch& x, ValueBatch y) {
    for (std::size_t first = 0; first < x.count();) {
        if (cancelled() || late()) throw IntegrandInterrupted{};
        const std::size_t slice = slice_.load(std::memory_order_relaxed);
        const std::size_t n = std::min(slice, x.count() - first);
        evaluations_.fetch_add(n, std::memory_order_relaxed);
        if (slice >= fast && n < worth_timing) {
            f(x.slice(first, n), y.slice(first, n));
        } else {
            const Clock::time_point begin = Clock::now();
            f(x.slice(first, n), y.slice(first, n));
            const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
            // Grows fourfold at most, for a few points say little about others.
            const double points =
                static_cast<double>(n) * std::min(4.0, slice_seconds / std::max(seconds, 1e-9));
            auto next = static_cast<std::size_t>(std::clamp(points, 1.0, 2.0 * fast));
            if (next >= 8) next -= next % 8;
            // The last slice of a batch may be short, and says then only that more would be too long.
            if (n == slice || seconds > slice_seconds) slice_.store(next, std::memory_order_relaxed);
        }
        first += n;
    }
}

Integrand interruptible(const Integrand& f, Interruption& interruption) {
    return f.with_function(
        [f, &interruption](const PointBatch& x, ValueBatch y) { interruption.evaluate(f, x, y); });
}

} // namespace montelux
