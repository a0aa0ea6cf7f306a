// WalkerEnsemble: walkers that move along the lines through one another, invariant under affine maps of space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/chains/log_density_calls.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux {

enum class EnsembleMove : std::uint8_t {
    // Goodman and Weare 2010, "Ensemble Samplers with Affine Invariance", equation 7: a walker moves towards another
    // one, or away, by a random factor of their distance.
    stretch,
    // Karamanis and Beutler 2021, "Ensemble Slice Sampling": Neal's slice sampler along the difference of two other
    // walkers. Takes about five evaluations for a state that depends far less on the last one.
    slice
};

// One half of the walkers moves while the other stays (Foreman-Mackey, Hogg, Lang, Goodman 2013, "emcee: The MCMC
// Hammer", section 3): so the product of the densities of all walkers is invariant, and the density is called for the
// whole half at once.
class WalkerEnsemble {
  public:
    // `starts`: points one after the other, at least four, where the density is above 0; they should span the space.
    // Throws Error where one has density 0.
    WalkerEnsemble(EnsembleMove move, LogDensityCalls density, std::vector<double> starts, std::uint64_t key,
                   std::uint32_t number);

    // Moves every walker once. During burn-in (`adapt`) the slices' first width is adapted.
    void step(bool adapt);

    std::span<const double> walker(std::size_t i) const { return std::span(x_).subspan(i * d_, d_); }
    std::size_t size() const { return log_p_.size(); }
    // Proposals, or slices, that moved their walker, since the last call of reset_counts.
    std::uint64_t moved() const { return moved_; }
    void reset_counts() { moved_ = 0; }
    const LogDensityCalls& density() const { return density_; }

  private:
    struct Half {
        std::size_t begin, end, other_begin, other_end;
    };
    struct Slice;
    void stretch(const Half& half);
    void slice(const Half& half);
    void evaluate();
    std::size_t choose(std::size_t begin, std::size_t end);

    EnsembleMove move_;
    LogDensityCalls density_;
    std::size_t d_;
    std::uint64_t key_;
    std::uint32_t number_;
    PhiloxStream numbers_;
    std::vector<double> x_, log_p_;
    // Points of which the density is asked for together, with its values there.
    std::vector<double> asked_, answers_;
    double width_ = 1; // of slices, in differences of walkers
    std::uint64_t steps_ = 0, adaptations_ = 0, moved_ = 0;
    std::uint64_t expansions_ = 0, contractions_ = 0; // of the slices of a step
};

} // namespace montelux
