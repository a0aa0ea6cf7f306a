// Diagnostics of a mean over Markov chains: error, autocorrelation time, effective sample size, convergence.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// The values of some observables along a chain, as means of consecutive batches. Batches double in length
// when there are too many, so memory is constant.
class ChainTrace {
  public:
    static constexpr std::size_t max_batches = 1024;

    ChainTrace() = default;
    explicit ChainTrace(int observables);

    int observables() const { return static_cast<int>(open_.size()); }
    void add(std::span<const double> values);
    // Complete batches, and how many states each one has.
    std::size_t batches() const { return batches_; }
    std::uint64_t batch_length() const { return length_; }
    // Mean of an observable over a batch, and the sum of squared deviations from that mean.
    double mean(int observable, std::size_t batch) const { return at(observable, batch).mean; }
    double squares(int observable, std::size_t batch) const { return at(observable, batch).squares; }

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    struct Batch {
        double mean = 0, squares = 0;
    };
    const Batch& at(int observable, std::size_t batch) const {
        return closed_[static_cast<std::size_t>(observable) * max_batches + batch];
    }
    void close();

    std::uint64_t length_ = 1, in_open_ = 0;
    std::size_t batches_ = 0;
    std::vector<Batch> open_, closed_;
};

struct ChainSummary {
    double mean = 0, standard_error = 0;
    double variance = 0; // of a single state
    // Variance of the mean times the number of states, over the variance of a state; 1 for independent ones.
    double autocorrelation_time = 1;
    double effective_sample_size = 0; // states of all chains over the autocorrelation time
    // Split R-hat: 1 when halves of chains agree as draws of one density do. Gelman and Rubin 1992; split as
    // in Vehtari, Gelman, Simpson, Carpenter, Buerkner 2021, "Rank-Normalization, Folding, and Localization:
    // An Improved R-hat", equations 1-4.
    double r_hat = 1;
};

// Of one observable over chains of equal lengths (complete batches only). The asymptotic variance is that of
// the batch means by the initial monotone sequence of Geyer 1992, "Practical Markov Chain Monte Carlo",
// section 3.3, about the mean over all chains, so that chains that disagree enlarge the error.
ChainSummary summarize(std::span<const ChainTrace> chains, int observable);
// Split R-hat alone; infinite while batches are too few.
double split_r_hat(std::span<const ChainTrace> chains, int observable);
// Correlation of the means of two observables, from the means of (at most) 16 blocks of each chain.
double correlation_of_means(std::span<const ChainTrace> chains, int a, int b);

} // namespace montelux
