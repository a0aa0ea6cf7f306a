#include "montelux/mc/integrate/stratified/recursive.h"

#include <cmath>
#include <string>
#include <utility>

#include "montelux/mc/integrate/stratified/bisection.h"
#include "montelux/mc/integrate/stratified/pass_estimator.h"
#include "montelux/mc/integrate/stratified/strata.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

class RecursiveEstimator final : public PassEstimator {
  public:
    RecursiveEstimator(const Problem& problem, const Recursive& settings)
        : PassEstimator(problem), pilot_(settings.pilot) {
        if (!(pilot_ >= 0.01 && pilot_ <= 0.5))
            throw Error("recursive",
                        "a pilot of " + std::to_string(pilot_) + " of the evaluations; expected 0.01 to 0.5");
    }

    StepOutcome step(const StepRequest& request) override {
        const std::uint64_t size = next_pass_size(evaluations(), request);
        if (size < 2) return StepOutcome::exhausted;
        auto boxes = bisect(problem(), size, pilot_, pilot_stream(), request.cancel);
        if (!boxes) return StepOutcome::cancelled;
        const Strata strata = boxes->strata();
        auto sum = sample_strata(problem(), strata, boxes->offsets, sample_stream(), nullptr, request.cancel);
        if (!sum) return StepOutcome::cancelled;
        Pass pass;
        pass.weight = std::pow(static_cast<double>(size), 1 + 2.0 / problem().evaluator.dimensions());
        pass.estimate = std::move(sum->estimate);
        pass.tail = std::move(sum->tail);
        pass.tail_values = sum->tail_values;
        pass.non_finite = std::move(boxes->non_finite);
        pass.non_finite.merge(sum->non_finite);
        pass.evaluations = boxes->pilot + boxes->offsets.back();
        add(pass);
        return StepOutcome::advanced;
    }

  private:
    double pilot_;
};

} // namespace

std::unique_ptr<Estimator> Recursive::estimator(const Problem& problem) const {
    return std::make_unique<RecursiveEstimator>(problem, *this);
}

} // namespace montelux
