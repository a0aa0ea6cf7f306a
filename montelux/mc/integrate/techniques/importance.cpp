#include "montelux/mc/integrate/techniques/importance.h"

#include <utility>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/quasi/quasi.h"
#include "montelux/mc/integrate/techniques/coverage_probe.h"
#include "montelux/mc/integrate/techniques/domain_restriction.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Sampling changes volume by the inverse of the density.
Domain sampled_domain(const Technique& technique) {
    return Domain::mapped_batch(
        technique.uniforms(), technique.dimensions(),
        [technique](const PointBatch& u, PointBuffer& x, std::span<double> volume) {
            technique.sample(u, x);
            std::vector<double> p(u.count());
            technique.density(x, p);
            for (std::size_t i = 0; i < p.size(); ++i) volume[i] /= p[i];
        },
        "density");
}

class ImportanceEstimator final : public Estimator {
  public:
    ImportanceEstimator(const Problem& problem, const Importance& settings)
        : problem_(problem), weighted_(restricted(problem.evaluator.integrand(), problem.evaluator.domain()),
                                       sampled_domain(settings.technique), problem.evaluator.policy()),
          probe_({settings.technique}), probes_(settings.probes) {
        const int expected = problem.evaluator.domain().dimensions();
        if (settings.technique.dimensions() != expected)
            throw Error("importance", "the density has " + std::to_string(settings.technique.dimensions()) +
                                          " dimensions, but the domain has " + std::to_string(expected));
        const Problem inner{weighted_, problem.seed, problem.full_covariance};
        samples_ = settings.points == ImportancePoints::random ? BasicMonteCarlo{}.estimator(inner)
                                                               : Quasi{}.estimator(inner);
    }

    StepOutcome step(const StepRequest& request) override {
        StepRequest inner = request;
        if (!probes_) return samples_->step(inner);
        const std::uint64_t now = probe_.due(samples_->tally().evaluations, request.max_evaluations);
        CoverageProbe probed = probe_;
        if (now > 0 && !probed.run(problem_, now, request.cancel)) return StepOutcome::cancelled;
        inner.max_evaluations -= now;
        const StepOutcome outcome = samples_->step(inner);
        if (outcome == StepOutcome::advanced) probe_ = std::move(probed);
        return outcome;
    }

    Tally tally() const override {
        Tally tally = samples_->tally();
        tally.evaluations += probe_.evaluations();
        probe_.warn(tally);
        return tally;
    }
    void save(StateWriter& state) const override {
        samples_->save(state);
        probe_.save(state);
    }
    void load(StateReader& state) override {
        samples_->load(state);
        probe_.load(state);
    }

  private:
    Problem problem_;
    Evaluator weighted_; // f / p over the technique's uniform numbers
    std::unique_ptr<Estimator> samples_;
    CoverageProbe probe_;
    bool probes_;
};

} // namespace

std::unique_ptr<Estimator> Importance::estimator(const Problem& problem) const {
    return std::make_unique<ImportanceEstimator>(problem, *this);
}

} // namespace montelux
