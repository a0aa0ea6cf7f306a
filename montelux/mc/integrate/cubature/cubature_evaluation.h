// Evaluates the integrand over regions: values, errors, and how to divide each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_regions.h"
#include "montelux/mc/integrate/cubature/symmetric_rule.h"
#include "montelux/mc/integrate/evaluator.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

// The regions that a step evaluates.
struct CubatureWork {
    const std::vector<const SymmetricRule*>& rules; // one per region of `fresh`
    const CubatureRegions& regions;                 // those that existed before
    const std::vector<std::size_t>& parents;        // fresh regions are their halves, two by two; or empty
    CubatureRegions& fresh;
    // Each half's prediction of the shared face, per region and component.
    std::vector<SymmetricRule::FaceValue>& faces;
    // If there is a single region: its known values at the first points of its rule, afterwards those at all
    // points; component after component.
    ValueBuffer* nested = nullptr;
    bool nested_not_finite = false; // were some of the known ones not finite?
    // May points where the integrand is not finite be evaluated again nearby? Each costs one more evaluation.
    bool may_shift = true;
};

// Evaluates all regions of `work.fresh` on all threads, and sets their values, errors and marks. `totals` are
// the components' values so far, by which their errors are compared; nonzero[c] is set where component c was
// other than zero anywhere; `shifted` grows by
// the evaluations that were repeated beside singularities. False when cancelled.
bool evaluate_regions(const Evaluator& evaluator, const CubatureWork& work, std::span<const double> totals,
                      NonFiniteCount& non_finite, std::uint64_t& shifted, std::vector<char>& nonzero,
                      const CancelFlag* cancel);

} // namespace montelux
