// Base of stratified estimators that work in passes: each pass is a complete estimate; passes are averaged
// with fixed weights.
#pragma once

#include <cstdint>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/iteration_average.h"
#include "montelux/mc/stats/pareto_tail.h"

namespace montelux {

// Sums the passes; a derived class only makes the next one.
class PassEstimator : public Estimator {
  public:
    Tally tally() const final;
    void save(StateWriter& state) const final;
    void load(StateReader& state) final;

  protected:
    struct Pass {
        // Decided before the pass ran; see IterationAverage.
        double weight = 0;
        IterationEstimate estimate;
        ParetoTail tail = {}; // as StrataSum has it
        std::uint64_t tail_values = 0;
        NonFiniteCount non_finite;
        std::uint64_t evaluations = 0; // pilot included
    };

    explicit PassEstimator(const Problem& problem);

    void add(const Pass& pass);

    const Problem& problem() const { return problem_; }
    std::uint64_t evaluations() const { return evaluations_; }
    std::uint32_t passes() const { return passes_; }
    // Streams of random numbers of this pass only.
    std::uint32_t sample_stream() const { return 2 * passes_; }
    std::uint32_t pilot_stream() const { return 2 * passes_ + 1; }

  private:
    Problem problem_;
    IterationAverage average_;
    ParetoTail tail_;
    std::uint64_t tail_values_ = 0;
    double points_ = 0; // that the tail is of
    NonFiniteCount non_finite_;
    std::uint64_t evaluations_ = 0;
    std::uint32_t passes_ = 0;
};

} // namespace montelux
