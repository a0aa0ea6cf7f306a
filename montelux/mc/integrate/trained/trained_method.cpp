#include "montelux/mc/integrate/trained/trained_method.h"

#include <string>
#include <utility>

#include "montelux/mc/integrate/adaptive/mixture_estimate.h"
#include "montelux/mc/integrate/vegas/vegas.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr std::uint64_t first_mixture_points = 256; // of each replicate
constexpr std::uint64_t most_mixture_step = 65536;

// A mixture that nothing changes, in replicates of Sobol' points.
class FixedMixtureEstimator final : public Estimator {
  public:
    FixedMixtureEstimator(const Problem& problem, std::shared_ptr<const UnitDensity> density, int replicates)
        : problem_(problem), density_(std::move(density)),
          estimate_(replicates, problem.evaluator.components()), replicates_(replicates) {}

    StepOutcome step(const StepRequest& request) override {
        const MixtureDensity& mixture = *density_->mixture();
        const std::uint64_t points = estimate_.points();
        const std::uint64_t end =
            estimate_.next_end(request, first_mixture_points, mixture.balanced_points(), most_mixture_step);
        if (end <= points) return StepOutcome::exhausted;
        const auto added = sample_mixture(problem_.evaluator, mixture, hash_key(problem_.seed, 3),
                                          replicates_, points, end, nullptr, request.cancel);
        if (!added) return StepOutcome::cancelled;
        estimate_.grow(*added, end);
        return StepOutcome::advanced;
    }

    Tally tally() const override {
        Tally tally;
        estimate_.tally(problem_.full_covariance, tally);
        tally.evaluations = estimate_.evaluations();
        tally.non_finite = estimate_.sums().non_finite;
        tally.ready = estimate_.compared();
        if (estimate_.points() == 0) return tally;
        estimate_.warn_of_tail(tally.standard_error[0], tally.warnings);
        if (!tally.warnings.empty()) tally.ready = false;
        if (estimate_.heavy_tailed(tally.standard_error[0])) {
            tally.ready = false;
            tally.warnings.push_back(
                "one sample makes up much of the standard error; the density does not fit the integrand");
        }
        if (estimate_.one_replicate_stands_out())
            tally.warnings.push_back(
                "one replicate stands far from the others; the error may be underestimated");
        return tally;
    }

    void save(StateWriter& state) const override { estimate_.save(state); }
    void load(StateReader& state) override { estimate_.load(state); }
    std::shared_ptr<const UnitDensity> density() const override { return density_; }

  private:
    Problem problem_;
    std::shared_ptr<const UnitDensity> density_;
    MixtureEstimate estimate_;
    int replicates_;
};

} // namespace

std::unique_ptr<Estimator> Trained::estimator(const Problem& problem) const {
    if (replicates < 4 || replicates > 4096) throw Error("trained", "expected 4 to 4096 replicates");
    const int dimensions = density.unit().dimensions();
    if (dimensions != problem.evaluator.dimensions())
        throw Error("trained", "the density has " + std::to_string(dimensions) +
                                   " dimensions; the integrand's domain takes " +
                                   std::to_string(problem.evaluator.dimensions()));
    if (const AdaptiveMap* map = density.unit().map())
        return Vegas{.training_iterations = 0, .map = *map}.estimator(problem);
    return std::make_unique<FixedMixtureEstimator>(problem, density.shared_unit(), replicates);
}

} // namespace montelux
