// Values of an integrand over the unit cube as they are, infinite ones included.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/mc/integrate/evaluator.h"

namespace montelux {

// Evaluates g at points of the unit cube, one after the other in memory, without the policy for values that are not
// finite: for looks that no estimate is made of.
class RawValues {
  public:
    explicit RawValues(const Evaluator& evaluator) : evaluator_(evaluator) {}

    const Evaluator& evaluator() const { return evaluator_; }
    std::uint64_t evaluations() const { return evaluations_; }
    // One row of components for each point.
    std::vector<std::vector<double>> operator()(const std::vector<std::vector<double>>& points);
    // Values of the integrand itself, without the change of volume, at points of the domain.
    std::vector<std::vector<double>> at(const std::vector<std::vector<double>>& points);

  private:
    const Evaluator& evaluator_;
    std::uint64_t evaluations_ = 0;
};

} // namespace montelux
