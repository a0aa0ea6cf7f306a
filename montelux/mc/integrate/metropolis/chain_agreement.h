// ChainAgreement: split R-hat of any number of chains, from running moments of their halves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "montelux/mc/stats/moments.h"

namespace montelux {

// sqrt(((n - 1) / n W + B) / W) for parts of n states: W is the mean variance of a state within a part, B the
// variance of the means of parts. Gelman, Rubin 1992, "Inference from Iterative Simulation Using Multiple
// Sequences". B / W is the reciprocal of the effective sample size of a part.
inline double r_hat_of(double states, double within, double between) {
    if (!(within > 0)) return between > 0 ? std::numeric_limits<double>::infinity() : 1;
    return std::sqrt(((states - 1) / states * within + between) / within);
}

// Constant memory, where ChainTrace keeps means of batches for autocorrelations, too. Trivially copyable.
template <int Observables>
class ChainAgreement {
  public:
    // The moments of an observable's values along half of a chain; all halves have the same number of states.
    void add(const ChannelMoments<Observables>& half) {
        if (half.count() < 2) return;
        states_ = half.count();
        means_.add(half.means());
        std::array<double, Observables> variances;
        for (int k = 0; k < Observables; ++k) variances[static_cast<std::size_t>(k)] = half.variance(k);
        within_.add(variances);
    }
    void merge(const ChainAgreement& other) {
        if (other.halves() == 0) return;
        states_ = other.states_;
        means_.merge(other.means_);
        within_.merge(other.within_);
    }

    std::uint64_t halves() const { return means_.count(); }
    // Split R-hat of an observable (ChainSummary::r_hat); infinite below four halves.
    double r_hat(int observable) const {
        if (halves() < 4) return std::numeric_limits<double>::infinity();
        return r_hat_of(static_cast<double>(states_), within_.mean(observable), means_.variance(observable));
    }
    // Of the observable where it is largest.
    double worst_r_hat() const {
        double worst = 0;
        for (int k = 0; k < Observables; ++k) worst = std::max(worst, r_hat(k));
        return worst;
    }

  private:
    std::uint64_t states_ = 0; // of a half
    ChannelMoments<Observables> means_, within_;
};

} // namespace montelux
