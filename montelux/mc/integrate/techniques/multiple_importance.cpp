#include "montelux/mc/integrate/techniques/multiple_importance.h"

#include <cmath>
#include <limits>
#include <utility>

#include "montelux/mc/integrate/iteration_average.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/techniques/coverage_probe.h"
#include "montelux/mc/integrate/techniques/semidefinite.h"
#include "montelux/mc/integrate/techniques/technique_samples.h"

namespace montelux {
namespace {

using Batch = TechniqueSampler::Batch;

// Sums of one technique's samples: moments of its values and, for optimal weights, the technique matrix and
// the contribution vectors.
struct TechniqueSum {
    SampleMoments samples;
    std::vector<double> matrix, vectors;

    void merge(const TechniqueSum& later) {
        samples.merge(later.samples);
        for (std::size_t k = 0; k < matrix.size(); ++k) matrix[k] += later.matrix[k];
        for (std::size_t k = 0; k < vectors.size(); ++k) vectors[k] += later.vectors[k];
    }
};

// Steps by whole rounds, with probes; derived classes sum a round for each kind of weights.
class RoundsEstimator : public Estimator {
  public:
    RoundsEstimator(const Problem& problem, const MultipleImportance& settings)
        : sampler_(problem, settings.techniques), probe_(sampler_.all()), probes_(settings.probes) {}

    StepOutcome step(const StepRequest& request) override {
        const std::uint64_t n = sampler_.samples_in_round();
        const std::uint64_t now = probes_ ? probe_.due(rounds_ * n, request.max_evaluations) : 0;
        const std::uint64_t limit = request.max_evaluations - now;
        const std::uint64_t size = step_size(rounds_ * n, limit);
        const std::uint64_t least = least_rounds();
        if (limit / n < least) return StepOutcome::exhausted;
        const std::uint64_t rounds = std::max(least, size / n);
        CoverageProbe probed = probe_;
        if (now > 0 && !probed.run(sampler_.problem(), now, request.cancel)) return StepOutcome::cancelled;
        std::vector<TechniqueSum> sums;
        for (std::size_t i = 0; i < sampler_.techniques(); ++i) {
            auto sum = sum_batches(
                rounds * sampler_.samples(i), [&] { return empty(i); },
                [&](std::uint64_t first, std::uint64_t count, TechniqueSum& to) {
                    Batch batch;
                    sampler_.draw(i, rounds_ * sampler_.samples(i) + first, count, batch,
                                  to.samples.non_finite);
                    add(i, batch, to);
                },
                request.cancel);
            if (!sum) return StepOutcome::cancelled;
            sums.push_back(std::move(*sum));
        }
        take(rounds, sums);
        for (const TechniqueSum& s : sums) non_finite_.merge(s.samples.non_finite);
        rounds_ += rounds;
        probe_ = std::move(probed);
        return StepOutcome::advanced;
    }

    Tally tally() const override {
        Tally tally;
        const auto m = static_cast<std::size_t>(components());
        tally.value.assign(m, 0.0);
        tally.standard_error.assign(m, std::numeric_limits<double>::infinity());
        fill(tally);
        tally.evaluations = rounds_ * sampler_.samples_in_round() + probe_.evaluations();
        tally.non_finite = non_finite_;
        probe_.warn(tally);
        return tally;
    }
    void save(StateWriter& state) const override {
        state.put(rounds_);
        montelux::save(state, non_finite_);
        probe_.save(state);
        save_sums(state);
    }
    void load(StateReader& state) override {
        rounds_ = state.get_word();
        montelux::load(state, non_finite_);
        probe_.load(state);
        load_sums(state);
    }

  protected:
    virtual std::uint64_t step_size(std::uint64_t done, std::uint64_t limit) const = 0;
    virtual std::uint64_t least_rounds() const = 0;
    // Of technique i, without samples.
    virtual TechniqueSum empty(std::size_t i) const = 0;
    // Turns f of a batch of technique i into its values and adds them.
    virtual void add(std::size_t i, Batch& batch, TechniqueSum& to) const = 0;
    virtual void take(std::uint64_t rounds, const std::vector<TechniqueSum>& sums) = 0;
    virtual void fill(Tally& tally) const = 0;
    virtual void save_sums(StateWriter& state) const = 0;
    virtual void load_sums(StateReader& state) = 0;

    int components() const { return sampler_.problem().evaluator.components(); }
    bool full() const { return sampler_.problem().full_covariance; }
    SampleMoments no_samples(const ExtremeValues& so_far) const {
        return {CovarianceMoments(components(), full()), {}, so_far.empty()};
    }
    // Warns of the first technique whose values, n_i of them, have a tail without a variance.
    static bool warn_of_tail(const ExtremeValues& extremes, std::uint64_t n, Tally& tally) {
        const std::size_t before = tally.warnings.size();
        warn_of_heavy_tail(extremes.tail(), n, static_cast<double>(n), tally.standard_error[0],
                           tally.warnings);
        return tally.warnings.size() > before;
    }

    TechniqueSampler sampler_;
    std::uint64_t rounds_ = 0;

  private:
    CoverageProbe probe_;
    bool probes_;
    NonFiniteCount non_finite_;
};

class HeuristicEstimator final : public RoundsEstimator {
  public:
    HeuristicEstimator(const Problem& problem, const MultipleImportance& settings)
        : RoundsEstimator(problem, settings), heuristic_(std::get<MisHeuristic>(settings.weights)),
          sums_(sampler_.techniques(), no_samples(ExtremeValues(components()))) {
        const double p = heuristic_.parameter;
        if (heuristic_.kind == MisHeuristic::Kind::power && !(p > 0 && std::isfinite(p)))
            throw Error("multiple_importance",
                        "a power of " + std::to_string(p) + "; expected one above zero");
        if (heuristic_.kind == MisHeuristic::Kind::cutoff && !(p >= 0 && p <= 1))
            throw Error("multiple_importance", "a cutoff of " + std::to_string(p) + "; expected 0 to 1");
    }

  private:
    std::uint64_t step_size(std::uint64_t done, std::uint64_t limit) const override {
        return next_step_size(done, 4096, limit);
    }
    std::uint64_t least_rounds() const override { return 1; }
    TechniqueSum empty(std::size_t i) const override { return {no_samples(sums_[i].extremes), {}, {}}; }

    void add(std::size_t i, Batch& batch, TechniqueSum& to) const override {
        const std::size_t count = batch.sum.size(), techniques = sampler_.techniques();
        const double n = static_cast<double>(sampler_.samples(i));
        const bool balance = heuristic_.kind == MisHeuristic::Kind::balance;
        std::vector<double> q(techniques);
        for (std::size_t j = 0; j < count; ++j) {
            double factor = n / batch.sum[j]; // w_i / p_i
            if (!balance) {
                for (std::size_t k = 0; k < techniques; ++k) q[k] = batch.q[k * count + j];
                factor = q[i] > 0 ? mis_weight(heuristic_, std::span<const double>(q), i) * n / q[i] : 0;
            }
            for (int c = 0; c < components(); ++c) {
                double& f = batch.f.component(c)[j];
                f = f == 0 ? 0 : f * factor;
            }
        }
        to.samples.add(batch.f);
    }
    void take(std::uint64_t, const std::vector<TechniqueSum>& sums) override {
        for (std::size_t i = 0; i < sums.size(); ++i) sums_[i].merge(sums[i].samples);
    }
    void fill(Tally& tally) const override {
        if (rounds_ == 0) return;
        Tally part;
        const auto m = static_cast<std::size_t>(components());
        std::vector<double> variance(m);
        for (const SampleMoments& s : sums_) {
            tally_mean(s.moments, part);
            raise_errors_of_few(s.extremes, s.moments.count(), part);
            for (std::size_t c = 0; c < m; ++c) {
                tally.value[c] += part.value[c];
                variance[c] += part.standard_error[c] * part.standard_error[c];
            }
            tally.covariance.resize(part.covariance.size());
            for (std::size_t k = 0; k < part.covariance.size(); ++k)
                tally.covariance[k] += part.covariance[k];
        }
        for (std::size_t c = 0; c < m; ++c) tally.standard_error[c] = std::sqrt(variance[c]);
        for (const SampleMoments& s : sums_)
            if (warn_of_tail(s.extremes, s.moments.count(), tally)) break;
    }
    void save_sums(StateWriter& state) const override {
        for (const SampleMoments& s : sums_) {
            montelux::save(state, s.moments);
            s.extremes.save(state);
        }
    }
    void load_sums(StateReader& state) override {
        for (SampleMoments& s : sums_) {
            montelux::load(state, s.moments);
            s.extremes.load(state);
        }
    }

    MisHeuristic heuristic_;
    std::vector<SampleMoments> sums_; // one per technique
};

class OptimalEstimator final : public RoundsEstimator {
  public:
    OptimalEstimator(const Problem& problem, const MultipleImportance& settings)
        : RoundsEstimator(problem, settings), average_(components(), full()),
          matrix_(sampler_.techniques() * sampler_.techniques()),
          vectors_(sampler_.techniques() * static_cast<std::size_t>(components())),
          extremes_(sampler_.techniques(), ExtremeValues(components())) {}

  private:
    std::uint64_t step_size(std::uint64_t done, std::uint64_t limit) const override {
        return next_step_size_after_pilot(done, limit);
    }
    // A variance needs two samples of each technique.
    std::uint64_t least_rounds() const override { return 2; }
    TechniqueSum empty(std::size_t i) const override {
        return {no_samples(extremes_[i]), std::vector<double>(matrix_.size()),
                std::vector<double>(vectors_.size())};
    }

    void add(std::size_t i, Batch& batch, TechniqueSum& to) const override {
        const std::size_t count = batch.sum.size(), techniques = sampler_.techniques();
        const double n = static_cast<double>(sampler_.samples(i));
        std::vector<double> ratio(techniques); // p_k / sum of q
        for (std::size_t j = 0; j < count; ++j) {
            const double sum = batch.sum[j];
            // Points with zero or infinite density do not enter the densities' integrals.
            const bool regular = sum > 0 && std::isfinite(sum);
            for (std::size_t k = 0; k < techniques; ++k)
                ratio[k] =
                    regular ? batch.q[k * count + j] / (static_cast<double>(sampler_.samples(k)) * sum) : 0;
            for (std::size_t k = 0; k < techniques; ++k)
                for (std::size_t l = 0; l <= k; ++l) to.matrix[k * techniques + l] += ratio[k] * ratio[l];
            for (int c = 0; c < components(); ++c) {
                double& f = batch.f.component(c)[j];
                const double g = regular ? f / sum : 0;
                const std::size_t column = static_cast<std::size_t>(c) * techniques;
                double fitted = 0;
                for (std::size_t k = 0; k < techniques; ++k) {
                    to.vectors[column + k] += ratio[k] * g;
                    if (!alpha_.empty()) fitted += alpha_[column + k] * ratio[k];
                }
                f = n * (g - fitted);
            }
        }
        to.samples.add(batch.f);
    }

    void take(std::uint64_t rounds, const std::vector<TechniqueSum>& sums) override {
        const std::size_t techniques = sampler_.techniques();
        if (!alpha_.empty()) {
            auto estimate = IterationEstimate::zero(components(), full());
            for (std::size_t c = 0; c < estimate.value.size(); ++c)
                for (std::size_t k = 0; k < techniques; ++k) estimate.value[c] += alpha_[c * techniques + k];
            for (std::size_t i = 0; i < sums.size(); ++i) {
                estimate.add_mean(sums[i].samples);
                extremes_[i].merge(sums[i].samples.extremes);
            }
            average_.add(static_cast<double>(rounds * sampler_.samples_in_round()), estimate);
            averaged_ += rounds;
        }
        for (const TechniqueSum& s : sums) {
            for (std::size_t k = 0; k < matrix_.size(); ++k) matrix_[k] += s.matrix[k];
            for (std::size_t k = 0; k < vectors_.size(); ++k) vectors_[k] += s.vectors[k];
        }
        alpha_ = solve_semidefinite(matrix_, vectors_, components());
    }

    void fill(Tally& tally) const override {
        average_.tally(tally);
        for (std::size_t i = 0; i < extremes_.size(); ++i)
            if (warn_of_tail(extremes_[i], averaged_ * sampler_.samples(i), tally)) break;
    }
    void save_sums(StateWriter& state) const override {
        average_.save(state);
        state.put(averaged_);
        for (const ExtremeValues& extremes : extremes_) extremes.save(state);
        state.put(matrix_);
        state.put(vectors_);
        state.put(alpha_);
    }
    void load_sums(StateReader& state) override {
        average_.load(state);
        averaged_ = state.get_word();
        for (ExtremeValues& extremes : extremes_) extremes.load(state);
        for (std::vector<double>* part : {&matrix_, &vectors_}) {
            std::vector<double> numbers = state.get_doubles();
            if (numbers.size() != part->size())
                throw Error("the saved state has another number of techniques");
            *part = std::move(numbers);
        }
        alpha_ = state.get_doubles();
        if (!alpha_.empty() && alpha_.size() != vectors_.size())
            throw Error("the saved state has another number of techniques");
    }

    IterationAverage average_;
    std::vector<double> matrix_;          // sum over all samples so far of p_k p_l / (sum of n p)^2
    std::vector<double> vectors_;         // f p_k / (sum of n p)^2, component by component
    std::vector<double> alpha_;           // likewise; empty before the pilot
    std::vector<ExtremeValues> extremes_; // of the averaged values of each technique,
    std::uint64_t averaged_ = 0;          // which are of this many rounds
};

} // namespace

std::unique_ptr<Estimator> MultipleImportance::estimator(const Problem& problem) const {
    if (std::holds_alternative<OptimalWeights>(weights))
        return std::make_unique<OptimalEstimator>(problem, *this);
    return std::make_unique<HeuristicEstimator>(problem, *this);
}

} // namespace montelux
