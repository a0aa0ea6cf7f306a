// The loop of all estimators: batches of points, evaluated on all threads, summed in a fixed order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/extreme_values.h"
#include "montelux/mc/integrate/interruptible.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/covariance_moments.h"

namespace montelux {

// Points of a batch: its buffers fit into the caches, and the cost of a call is small.
inline constexpr std::uint64_t batch_size = 1024;
// Batches that one task takes: its sums are merged once.
inline constexpr std::uint64_t batches_per_task = 4;

// Runs add(first, count, sum) for consecutive runs [first, first + count) of [0, count_all), on all threads,
// and merges the sums in order. `Sum` is default constructible by make() and has merge(const Sum&). Empty
// when cancelled or interrupted.
template <typename Make, typename Add, typename Sum = std::invoke_result_t<const Make&>>
std::optional<Sum> sum_batches(std::uint64_t count, const Make& make, const Add& add,
                               const CancelFlag* cancel) {
    const std::uint64_t task = batch_size * batches_per_task;
    const auto tasks = static_cast<std::int64_t>((count + task - 1) / task);
    auto run = [&](std::int64_t t) {
        Sum sum = make();
        const std::uint64_t begin = static_cast<std::uint64_t>(t) * task, end = std::min(count, begin + task);
        for (std::uint64_t first = begin; first < end; first += batch_size)
            add(first, std::min(batch_size, end - first), sum);
        return sum;
    };
    auto combine = [](Sum a, const Sum& b) {
        a.merge(b);
        return a;
    };
    if (tasks == 0) return make();
    try {
        return parallel_reduce_ordered(tasks, run, combine, cancel);
    } catch (const IntegrandInterrupted&) {
        return std::nullopt;
    }
}

// Moments of samples, and what was not finite among them; their extreme values where `extremes` has
// components.
struct SampleMoments {
    CovarianceMoments moments;
    NonFiniteCount non_finite;
    ExtremeValues extremes = {};

    // All values of a batch.
    void add(const ValueBuffer& values);
    // The same, summarised by a device.
    void add(const DeviceSummary& values, std::uint64_t count);
    void merge(const SampleMoments& later) {
        moments.merge(later.moments);
        non_finite.merge(later.non_finite);
        extremes.merge(later.extremes);
    }
};

// Fills value, standard_error and covariance of `tally` from moments whose mean is the estimate and whose
// covariance, divided by `count`, is that of the mean.
void tally_mean(const CovarianceMoments& moments, Tally& tally);
void tally_mean(const SampleMoments& samples, Tally& tally);
// Raises errors of means of n values if too few of the values contribute to them.
void raise_errors_of_few(const ExtremeValues& extremes, std::uint64_t n, Tally& tally);
// The same, and warns of heavy tails.
void judge_extremes(const ExtremeValues& extremes, std::uint64_t n, Tally& tally);
// Standard errors of at least `least`, one per component; covariances grow in proportion.
void raise_standard_errors(std::span<const double> least, Tally& tally);

void save(StateWriter& state, const CovarianceMoments& moments);
void load(StateReader& state, CovarianceMoments& moments);
void save(StateWriter& state, const NonFiniteCount& count);
void load(StateReader& state, NonFiniteCount& count);

// Evaluations after which a step may end, so that progress and checkpoints are frequent.
inline constexpr std::uint64_t large_step = 1 << 20;

// The size of the next step after `done` evaluations, within `limit`: doubling at first, later a tenth, so
// that a run can stop near its target.
std::uint64_t next_step_size(std::uint64_t done, std::uint64_t first, std::uint64_t limit);
// The same for an estimator whose first step is a pilot: a sixteenth of the limit at most.
std::uint64_t next_step_size_after_pilot(std::uint64_t done, std::uint64_t limit);

} // namespace montelux
