#include "montelux/mc/integrate/interruptible.h"

#include <algorithm>
#include <utility>

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

constexpr double slice_seconds = 0.02;
// From here on a slice holds any batch, and only large batches are timed.
constexpr std::size_t fast = 4096, worth_timing = 256;
// Batches of slower points are shared among the threads; far above the cost of handing over a slice.
constexpr double slow_point_seconds = 20e-6;
// Shortest slice for sharing: a tenth of the usual time, a few for each thread.
constexpr std::size_t least_share = 10, slices_per_thread = 4;

std::size_t in_eights(std::size_t points) { return points < 8 ? points : points - points % 8; }

// Points of a slice of a batch whose slices are evaluated in parallel.
std::size_t shared_slice(std::size_t slice, std::size_t points) {
    const auto pieces = slices_per_thread * static_cast<std::size_t>(thread_count());
    const std::size_t fair = (points + pieces - 1) / pieces;
    // At least eight points if the slice has them: vectorised functions may evaluate fewer differently.
    const std::size_t least = std::max(slice / least_share, std::min<std::size_t>(slice, 8));
    return in_eights(std::clamp(fair, least, slice));
}

} // namespace

void Interruption::evaluate(const Integrand& f, const PointBatch& x, ValueBatch y) {
    for (std::size_t first = 0; first < x.count();) {
        const std::size_t slice = slice_.load(std::memory_order_relaxed), left = x.count() - first;
        if (left > slice && point_seconds_.load(std::memory_order_relaxed) > slow_point_seconds &&
            thread_count() > 1)
            return evaluate_in_parallel(f, x.slice(first, left), y.slice(first, left), slice);
        const std::size_t n = std::min(slice, left);
        evaluate_slice(f, x.slice(first, n), y.slice(first, n), slice, slice);
        first += n;
    }
}

void Interruption::evaluate_in_parallel(const Integrand& f, const PointBatch& x, ValueBatch y,
                                        std::size_t slice) {
    const std::size_t shared = shared_slice(slice, x.count());
    const auto slices = static_cast<std::int64_t>((x.count() + shared - 1) / shared);
    // Isolated: the estimator's batch is half done, in scratch memory that belongs to this thread.
    parallel_for_isolated(slices, [&](std::int64_t i) {
        const std::size_t first = static_cast<std::size_t>(i) * shared;
        const std::size_t n = std::min(shared, x.count() - first);
        evaluate_slice(f, x.slice(first, n), y.slice(first, n), shared, slice);
    });
}

void Interruption::begin(std::size_t points) {
    if (cancelled() || late()) throw IntegrandInterrupted{};
    evaluations_.fetch_add(points, std::memory_order_relaxed);
}

// `whole` points make a slice that is not the last of its batch; `slice` is what a slice held at most.
void Interruption::evaluate_slice(const Integrand& f, const PointBatch& x, ValueBatch y, std::size_t whole,
                                  std::size_t slice) {
    const std::size_t n = x.count();
    begin(n);
    if (slice >= fast && n < worth_timing) return f(x, y);

    const Clock::time_point begin = Clock::now();
    f(x, y);
    const double seconds = std::max(std::chrono::duration<double>(Clock::now() - begin).count(), 1e-9);
    // A short last slice only gives an upper bound.
    if (n != whole && seconds <= slice_seconds) return;
    const double points = static_cast<double>(n);
    // Grows at most fourfold, since a few points say little about others.
    const double limit = std::min(4.0 * static_cast<double>(slice), 2.0 * fast);
    const double next = std::clamp(points * slice_seconds / seconds, 1.0, limit);
    slice_.store(in_eights(static_cast<std::size_t>(next)), std::memory_order_relaxed);
    point_seconds_.store(seconds / points, std::memory_order_relaxed);
}

Integrand interruptible(const Integrand& f, Interruption& interruption) {
    OnDevice device = f.on_device();
    device.before.emplace_back([&interruption](std::size_t points) { interruption.begin(points); });
    return f
        .with_function(
            [f, &interruption](const PointBatch& x, ValueBatch y) { interruption.evaluate(f, x, y); })
        .with_device(std::move(device));
}

} // namespace montelux
