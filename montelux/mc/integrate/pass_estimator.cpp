#include "montelux/mc/integrate/pass_estimator.h"

#include "montelux/mc/integrate/sampling.h"

namespace montelux {

PassEstimator::PassEstimator(const Problem& problem)
    : problem_(problem), average_(problem.evaluator.components(), problem.full_covariance) {}

void PassEstimator::add(const Pass& pass) {
    average_.add(pass.weight, pass.estimate);
    non_finite_.merge(pass.non_finite);
    evaluations_ += pass.evaluations;
    ++passes_;
}

Tally PassEstimator::tally() const {
    Tally tally;
    average_.tally(tally);
    tally.evaluations = evaluations_;
    tally.non_finite = non_finite_;
    return tally;
}

void PassEstimator::save(StateWriter& state) const {
    average_.save(state);
    state.put(evaluations_);
    state.put(passes_);
    montelux::save(state, non_finite_);
}

void PassEstimator::load(StateReader& state) {
    average_.load(state);
    evaluations_ = state.get_word();
    passes_ = state.get<std::uint32_t>();
    montelux::load(state, non_finite_);
}

} // namespace montelux
