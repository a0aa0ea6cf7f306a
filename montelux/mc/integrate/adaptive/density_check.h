// Looks for parts of the integral that a trained density hardly samples, before its result is believed.
#pragma once

#include <cstdint>

#include "montelux/mc/integrate/adaptive/density_trainer.h"
#include "montelux/mc/integrate/adaptive/mixture_estimate.h"
#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// Replicates that all miss the far end of a ridge agree with one another, so their spread does not show it.
// Walkers reach it along the ridge. A check holds until the points have grown fourfold.
class DensityCheck {
  public:
    // Has the density of `points` points of a replicate been checked, or does it need no check? Only those of
    // concentrated integrands do, whose peaks and ridges may reach farther than the density.
    bool covers(const DensityTrainer& trainer, std::uint64_t points) const;
    // Is a check due? Before a target is claimed, and at `early` points, so that a bad density is found soon.
    bool due(const DensityTrainer& trainer, const MixtureEstimate& estimate, const StepRequest& request,
             std::uint64_t early) const;
    // Walks; the evaluations count as the trainer's. `again`: whether the density can be fitted again, which is
    // asked for by a smaller share than a warning. False if too few evaluations are left: nothing changed.
    bool run(DensityTrainer& trainer, const MixtureEstimate& estimate, const StepRequest& request,
             bool again);
    // Share of the integral that is hardly sampled; 0 where it is small for the target.
    double unseen() const { return unseen_; }
    void warn(Tally& tally) const;

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    std::uint64_t checked_points_ = 0; // of a replicate
    double unseen_ = 0;
};

} // namespace montelux
