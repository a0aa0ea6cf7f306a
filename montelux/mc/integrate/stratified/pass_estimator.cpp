#include "montelux/mc/integrate/stratified/pass_estimator.h"

#include "montelux/mc/integrate/sampling.h"

namespace montelux {

PassEstimator::PassEstimator(const Problem& problem)
    : problem_(problem), average_(problem.evaluator.components(), problem.full_covariance) {}

void PassEstimator::add(const Pass& pass) {
    average_.add(pass.weight, pass.estimate);
    tail_.merge(pass.tail);
    tail_values_ += pass.tail_values;
    points_ += pass.estimate.points;
    non_finite_.merge(pass.non_finite);
    evaluations_ += pass.evaluations;
    ++passes_;
}

Tally PassEstimator::tally() const {
    Tally tally;
    average_.tally(tally);
    tally.evaluations = evaluations_;
    tally.non_finite = non_finite_;
    if (tally.ready)
        warn_of_heavy_tail(tail_, tail_values_, points_, tally.standard_error[0], tally.warnings);
    return tally;
}

void PassEstimator::save(StateWriter& state) const {
    average_.save(state);
    state.put(evaluations_);
    state.put(passes_);
    state.put(tail_.values());
    state.put(tail_values_);
    state.put(points_);
    montelux::save(state, non_finite_);
}

void PassEstimator::load(StateReader& state) {
    average_.load(state);
    evaluations_ = state.get_word();
    passes_ = state.get<std::uint32_t>();
    tail_.restore(state.get_doubles());
    tail_values_ = state.get_word();
    points_ = state.get_double();
    montelux::load(state, non_finite_);
}

} // namespace montelux
