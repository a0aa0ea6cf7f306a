#include "montelux/mc/integrate/recursive.h"

#include <cmath>
#include <utility>

#include "montelux/mc/integrate/bisection.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

class RecursiveEstimator final : public Estimator {
  public:
    RecursiveEstimator(const Problem& problem, const Recursive& settings)
        : problem_(problem), pilot_(settings.pilot),
          average_(problem.evaluator.components(), problem.full_covariance) {
        if (!(pilot_ >= 0.01 && pilot_ <= 0.5))
            throw Error("recursive",
                        "a pilot of " + std::to_string(pilot_) + " of the evaluations; expected 0.01 to 0.5");
    }

    StepOutcome step(const StepRequest& request) override {
        const std::uint64_t size = next_pass_size(evaluations_, request);
        if (size < 2) return StepOutcome::exhausted;
        auto boxes = bisect(problem_, size, pilot_, 2 * passes_ + 1, request.cancel);
        if (!boxes) return StepOutcome::cancelled;
        const Strata strata = boxes->strata();
        auto sum = sample_strata(problem_, strata, boxes->offsets, 2 * passes_, nullptr, request.cancel);
        if (!sum) return StepOutcome::cancelled;
        const double weight = std::pow(static_cast<double>(size), 1 + 2.0 / problem_.evaluator.dimensions());
        average_.add(weight, sum->estimate);
        non_finite_.merge(boxes->non_finite);
        non_finite_.merge(sum->non_finite);
        evaluations_ += boxes->pilot + boxes->offsets.back();
        ++passes_;
        return StepOutcome::advanced;
    }

    Tally tally() const override {
        Tally tally;
        average_.tally(tally);
        tally.evaluations = evaluations_;
        tally.non_finite = non_finite_;
        return tally;
    }
    void save(StateWriter& state) const override {
        average_.save(state);
        state.put(evaluations_);
        state.put(passes_);
        montelux::save(state, non_finite_);
    }
    void load(StateReader& state) override {
        average_.load(state);
        evaluations_ = state.get_word();
        passes_ = state.get<std::uint32_t>();
        montelux::load(state, non_finite_);
    }

  private:
    Problem problem_;
    double pilot_;
    IterationAverage average_;
    NonFiniteCount non_finite_;
    std::uint64_t evaluations_ = 0;
    std::uint32_t passes_ = 0;
};

} // namespace

std::unique_ptr<Estimator> Recursive::estimator(const Problem& problem) const {
    return std::make_unique<RecursiveEstimator>(problem, *this);
}

} // namespace montelux
