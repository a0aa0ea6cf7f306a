#include "montelux/mc/integrate/vegas/vegas.h"

#include "montelux/mc/integrate/vegas/vegas_base.h"

namespace montelux {
namespace {

std::unique_ptr<VegasEstimator> make(const Problem& problem, const Vegas& settings) {
    return settings.points == Vegas::Points::sobol ? sobol_vegas(problem, settings)
                                                   : stratified_vegas(problem, settings);
}

} // namespace

std::unique_ptr<Estimator> Vegas::estimator(const Problem& problem) const { return make(problem, *this); }

std::unique_ptr<Estimator> VegasSobol::estimator(const Problem& problem) const {
    Vegas sobol = settings;
    sobol.points = Vegas::Points::sobol;
    return make(problem, sobol);
}

AdaptiveMap train_map(const Evaluator& g, std::uint64_t evaluations, const Vegas& settings,
                      std::uint64_t seed) {
    const std::unique_ptr<VegasEstimator> estimator = make({g, seed, false}, settings);
    for (;;) {
        const std::uint64_t done = estimator->tally().evaluations;
        if (done >= evaluations) break;
        if (estimator->step({.max_evaluations = evaluations - done}) != StepOutcome::advanced) break;
    }
    return estimator->map();
}

} // namespace montelux
