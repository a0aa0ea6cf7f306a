// Batches of samples for multiple importance sampling: points of one technique, the densities of all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/techniques/multiple_importance.h"

namespace montelux {

// The techniques of one problem, and its integrand at the points that they draw.
class TechniqueSampler {
  public:
    // Leaves out techniques without samples. Throws Error where none is left or dimensions differ.
    TechniqueSampler(const Problem& problem, const std::vector<WeightedTechnique>& techniques);

    std::size_t techniques() const { return techniques_.size(); }
    std::uint64_t samples(std::size_t i) const { return techniques_[i].samples; } // in a round
    std::uint64_t samples_in_round() const { return in_round_; }
    std::vector<Technique> all() const;
    const Problem& problem() const { return problem_; }

    struct Batch {
        PointBuffer u, x;
        ValueBuffer f;
        // q[k * count + j] = n_k p_k(x_j).
        std::vector<double> q;
        std::vector<double> sum; // over k
    };
    // Samples first, first + 1, ... of technique i. Where f is not zero but the density of technique i itself
    // is, f is set to zero and the point counts as not finite (or throws Error, by the policy).
    void draw(std::size_t i, std::uint64_t first, std::uint64_t count, Batch& batch,
              NonFiniteCount& non_finite) const;

  private:
    Problem problem_;
    std::vector<WeightedTechnique> techniques_;
    std::uint64_t in_round_ = 0;
    Evaluator f_;
};

} // namespace montelux
