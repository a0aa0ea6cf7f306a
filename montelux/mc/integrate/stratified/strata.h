// Samples within given boxes of the unit cube, and the sum over them: the core of stratified sampling.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/iteration_average.h"
#include "montelux/mc/stats/pareto_tail.h"

namespace montelux {

// Disjoint boxes that together are the unit cube.
struct Strata {
    std::uint64_t count = 0;
    // Fills the lower corner and the widths of a box.
    std::function<void(std::uint64_t stratum, std::span<double> lower, std::span<double> width)> box;
};

// Grid cells, cells[d] along variable d; the first variable fastest.
Strata grid_strata(std::vector<std::uint64_t> cells);
// Cells along each of `dimensions` variables, as equal as can be, with a product of at most `count`.
std::vector<std::uint64_t> balanced_cells(int dimensions, std::uint64_t count);

struct StrataSum {
    // Sum over strata of volume * mean of its samples; the variance adds volume^2 * s^2 / n. Both unbiased.
    IterationEstimate estimate;
    // If there is one component: tail of the largest deviation in each stratum, times the sample's share
    // times the number of samples.
    ParetoTail tail;
    std::uint64_t tail_values = 0;
    NonFiniteCount non_finite;
};

// Stratum k gets samples offsets[k] to offsets[k + 1] of stream (seed, stream), at least 2. Where `variances`
// is given it gets, of all strata, the variances of all components. Empty when cancelled.
std::optional<StrataSum> sample_strata(const Problem& problem, const Strata& strata,
                                       std::span<const std::uint64_t> offsets, std::uint32_t stream,
                                       std::vector<double>* variances, const CancelFlag* cancel);

// Offsets of `samples` samples in all, `least` in each stratum and the rest in proportion to `shares` (equal
// if they are empty or sum to zero).
std::vector<std::uint64_t> allocate_samples(std::uint64_t strata, std::uint64_t samples, std::uint64_t least,
                                            std::span<const double> shares);

// The samples of the next pass; larger passes have finer strata. Without a target all that is left, else
// doublings; limited so that a pass is short and its strata fit into memory.
std::uint64_t next_pass_size(std::uint64_t done, const StepRequest& request);

} // namespace montelux
