#include "montelux/mc/integrate/adaptive/adaptive.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "montelux/mc/integrate/adaptive/density_check.h"
#include "montelux/mc/integrate/adaptive/density_trainer.h"
#include "montelux/mc/integrate/adaptive/mixture_estimate.h"
#include "montelux/mc/integrate/trained/unit_density.h"
#include "montelux/mc/integrate/witness/first_look.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/sobol.h"

namespace montelux {
namespace {

constexpr std::uint64_t training_points = 2048;      // of a round, at first
constexpr std::uint64_t least_round = 64;            // of few evaluations,
constexpr std::uint64_t least_explored = 8;          // points of a replicate, as a share of the same,
constexpr std::uint64_t few_evaluations = 16384;     // which are fewer than these
constexpr int share_step_of_few = 8;                 // granularity of shares, as a share of the same
constexpr std::uint64_t max_training_points = 65536; // of a round
constexpr int max_rounds = 24;
constexpr int max_retrainings = 4;
constexpr double fixed_training_share = 0.2; // of a fixed number of evaluations,
constexpr double least_training = 20000; // or this many, if they are at most a third or, of a fixed number
constexpr double enough_for_half = 4096; // above this, a half: three rounds fit far better than two
constexpr double disagreement = 2e-3;    // p-value of the training rounds below which there is a warning
constexpr std::uint64_t enough_nonzero = 16;        // non-zero points needed before training begins,
constexpr std::uint64_t few_nonzero = 4;            // the same, where a quarter of all has been explored,
constexpr std::uint64_t most_exploration = 1 << 20; // or evaluations without
constexpr double peaky = 0.1; // effective share of exploring points below which peaks are searched for
constexpr double narrow_peaks = 0.01;        // the same, where the search is thorough
constexpr double trusted_exploration = 0.05; // the same, above which the error of uniform points is believed
constexpr double flat = 0.6; // the same, of integrands that uniform points are likely to be best for
constexpr double uniform_reach = 32768; // evaluations within which uniform points may be expected to converge
// Evaluations of a survey around narrow peaks, per squared number of variables; and the most variables in which points
// there still find another peak.
constexpr std::uint64_t survey_points = 128, most_surveyed = 6;
// Points of an indicator that tell its error, and evaluations within which uniform points are expected to reach a target.
constexpr std::uint64_t enough_hits = 16;
constexpr double reach_of_indicators = 1 << 24;
// Uniform points behind a claim in several variables: all of them miss a region of 1/5000 of the cube in 4 %
// of cases.
constexpr std::uint64_t plateau_evaluations = 16384;
constexpr double even_values = 0.7;          // effective share of exploring points of a plateau
constexpr std::uint64_t most_kept = 1 << 18; // uniform points of a step that are kept for training
constexpr double surprise_matters = 2;       // error over target from which heavy weights matter
constexpr double much_sooner = 0.5;      // share of the expected rest below which uniform points are resumed
constexpr double negligible_peak = 1e-4; // of the integral of |g|
constexpr std::uint64_t early_check = 4; // first samples after which a density is checked
constexpr std::uint64_t step_points = 65536; // of each replicate in one step
constexpr std::uint64_t smallest_budget = 4; // rounds that must be affordable for training to begin

class AdaptiveEstimator final : public Estimator {
  public:
    AdaptiveEstimator(const Problem& problem, const Adaptive& settings)
        : problem_(problem), settings_(settings), device_(DeviceValues::of(problem.evaluator)),
          explored_(std::max<std::uint64_t>(
              problem.evaluator.dimensions() == 1 ? 128 : 256,
              std::bit_ceil(4 * static_cast<std::uint64_t>(problem.evaluator.dimensions())))),
          trainer_(problem, std::max(1, static_cast<int>(
                                            std::lround(settings.uniform_share * MixtureDensity::units)))),
          cube_(problem.evaluator.dimensions()),
          round_points_(std::max<std::uint64_t>(1, explored_ / 256) * training_points),
          uniform_(settings.replicates, problem.evaluator.components()), weighted_(uniform_),
          kept_(uniform_) {
        // Now, not within a step whose time is measured.
        if (device_) device_->sampler().prepare_mixtures();
    }

    StepOutcome step(const StepRequest& request) override {
        switch (phase_) {
        case Phase::explore:
            return explore(request);
        case Phase::search:
            return search(request);
        case Phase::train:
            return train(request);
        case Phase::weighted:
            if (has_new_peaks()) return consider_peaks();
            if (check_.due(trainer_, weighted_, request, early_check * first_sample())) return check(request);
            return sample(request, trainer_.density(), 2, weighted_);
        default:
            if (has_new_peaks()) return consider_peaks();
            return sample(request, cube_, 0, uniform_);
        }
    }

    Tally tally() const override {
        const MixtureEstimate& estimate = best();
        const bool weighted = &estimate == &weighted_, earlier = &estimate == &kept_;
        Tally tally;
        estimate.tally(problem_.full_covariance, tally);
        tally.evaluations = evaluations();
        tally.non_finite = trainer_.non_finite();
        tally.non_finite.merge(uniform_.sums().non_finite);
        tally.non_finite.merge(weighted_.sums().non_finite);
        tally.non_finite.merge(abandoned_non_finite_);
        tally.ready = !has_new_peaks() && !earlier && estimate.compared() &&
                      (phase_ == Phase::uniform || weighted) &&
                      (weighted || !plateau() || uniform_.evaluations() >= plateau_evaluations) &&
                      (!weighted || check_.covers(trainer_, weighted_.points()));
        if (estimate.points() == 0) return tally;
        if (weighted)
            for (const DensityTrainer::Check& check : trainer_.checks()) {
                const double variance = check.variance + tally.standard_error[0] * tally.standard_error[0];
                if (!(variance > 0)) continue;
                tally.chi_squared += std::pow(check.value - tally.value[0], 2) / variance;
                ++tally.degrees_of_freedom;
            }
        // The largest of uniform points may have a large weight without being a surprise.
        const bool heavy = (weighted || earlier) && estimate.heavy_tailed(tally.standard_error[0]);
        const bool lost = (weighted || earlier) && estimate.lost_what_is_in(uniform_);
        std::vector<std::string> tail;
        estimate.warn_of_tail(tally.standard_error[0], tail);
        const bool unseen = weighted && check_.unseen() > 0;
        if (heavy || lost || unseen || !tail.empty()) tally.ready = false;
        tally.warnings = std::move(tail);
        if (weighted) check_.warn(tally);
        add_warnings(estimate, heavy, lost, tally);
        return tally;
    }

    std::shared_ptr<const UnitDensity> density() const override {
        return std::make_shared<const UnitDensity>(trainer_.rounds() > 0 ? trainer_.density() : cube_);
    }
    std::shared_ptr<const UnitDensity> sampled_density() const override {
        return &best() == &uniform_ ? nullptr : density();
    }
    void save(StateWriter& state) const override {
        state.put(static_cast<int>(phase_));
        state.put(previous_variance_);
        state.put(explored_);
        state.put(round_points_);
        state.put(training_goal_);
        state.put(retrained_);
        state.put(known_peaks_);
        check_.save(state);
        state.put(abandoned_evaluations_);
        montelux::save(state, abandoned_non_finite_);
        trainer_.save(state);
        uniform_.save(state);
        weighted_.save(state);
        kept_.save(state);
    }
    void load(StateReader& state) override {
        phase_ = static_cast<Phase>(std::clamp(state.get<int>(), 0, static_cast<int>(Phase::uniform)));
        previous_variance_ = state.get_double();
        explored_ = state.get_word();
        round_points_ = state.get_word();
        training_goal_ = state.get_double();
        retrained_ = state.get<int>();
        known_peaks_ = state.get_word();
        check_.load(state);
        abandoned_evaluations_ = state.get_word();
        montelux::load(state, abandoned_non_finite_);
        trainer_.load(state);
        uniform_.load(state);
        weighted_.load(state);
        kept_.load(state);
    }

  private:
    enum class Phase { explore, search, train, weighted, uniform };

    std::uint64_t evaluations() const {
        return uniform_.evaluations() + weighted_.evaluations() + trainer_.evaluations() +
               abandoned_evaluations_;
    }
    // Chosen by numbers of points alone, so that the choice does not bias it.
    const MixtureEstimate& best() const {
        if (phase_ == Phase::explore || phase_ == Phase::uniform) return uniform_;
        if (phase_ == Phase::weighted && weighted_.points() > 0 && weighted_.points() >= kept_.points())
            return weighted_;
        return kept_.points() > 0 ? kept_ : uniform_;
    }
    std::uint64_t replicates() const { return static_cast<std::uint64_t>(settings_.replicates); }

    // Points of each replicate: an eighth of a small fixed number of evaluations.
    std::uint64_t exploration(const StepRequest& request) const {
        if (request.targeted()) return explored_;
        const std::uint64_t eighth =
            std::bit_floor(std::max<std::uint64_t>(request.max_evaluations / (8 * replicates()), 1));
        return std::clamp(eighth, std::min(least_explored, explored_), explored_);
    }
    // Doubles while hardly any point is non-zero.
    StepOutcome explore(const StepRequest& request) {
        const bool first = uniform_.points() == 0;
        const std::uint64_t explored = first ? exploration(request) : explored_;
        std::uint64_t points = first ? explored : uniform_.points();
        points = std::min(points, request.max_evaluations / replicates());
        if (points == 0) return StepOutcome::exhausted;
        SamplePoints drawn;
        auto sums =
            sample_mixture(problem_.evaluator, cube_, hash_key(problem_.seed, 0), settings_.replicates,
                           uniform_.points(), uniform_.points() + points, &drawn, request.cancel);
        if (!sums) return StepOutcome::cancelled;
        if (explored < explored_) { // of few evaluations the rounds of training, too, are a share
            round_points_ = std::clamp(request.max_evaluations / 8, least_round, round_points_);
            if (request.max_evaluations < few_evaluations) trainer_.set_share_step(share_step_of_few);
        }
        explored_ = explored;
        uniform_.explore(*sums, uniform_.points() + points);
        trainer_.start(std::move(drawn));
        const std::uint64_t left = request.max_evaluations - sums->evaluations;
        const bool room = uniform_.points() >= explored_ && left >= smallest_budget * round_points_;
        if (left >= smallest_budget * least_round && misses_a_peak(cube_, uniform_)) {
            if (!room) round_points_ = std::clamp(left / 8, least_round, round_points_);
            known_peaks_ = problem_.look->peaks.size();
            phase_ = Phase::search;
        } else if (!room || uniform_will_do(request))
            phase_ = Phase::uniform;
        else if (trainer_.nonzero() >= enough_nonzero ||
                 (trainer_.nonzero() >= few_nonzero && 3 * uniform_.evaluations() >= left) ||
                 uniform_.evaluations() >= most_exploration)
            phase_ = trainer_.nonzero() == 0 ? Phase::uniform : first_training();
        return StepOutcome::advanced;
    }
    bool is_hit_indicator() const {
        return trainer_.flat_where_nonzero() && trainer_.nonzero() >= enough_hits;
    }
    // Errors of low-discrepancy points fall more slowly at jumps across a surface (He and Wang 2015, "On the convergence
    // rate of randomized quasi-Monte Carlo for discontinuous functions").
    double expected_rest_of_indicator(const StepRequest& request) const {
        const double n = problem_.evaluator.dimensions();
        const bool jumps = trainer_.nonzero() < uniform_.all_points();
        return jumps ? uniform_.expected_rest(request, (n + 1) / (2 * n)) : uniform_.expected_rest(request);
    }
    // Was a peak seen that points of this density do not explain?
    bool misses_a_peak(const MixtureDensity& density, const MixtureEstimate& estimate) const {
        if (!problem_.look || problem_.look->peaks.empty() || estimate.points() == 0) return false;
        const bool indicator = density.gaussians().empty() && is_hit_indicator();
        Tally tally;
        estimate.tally(false, tally);
        for (const Witness& peak : problem_.look->peaks) {
            if (indicator && trainer_.is_of_flat_size(peak.value)) continue; // hits tell of all of it
            const double q = pdf_at(density, peak.u);
            for (std::size_t c = 0; c < tally.value.size(); ++c) {
                const double mass =
                    unexplained(peak.value[c], peak.volume, q, static_cast<double>(estimate.all_points()),
                                tally.absolute[c]);
                if (mass > negligible_peak * std::max(tally.absolute[c], std::abs(tally.standard_error[c])))
                    return true;
            }
        }
        return false;
    }
    // Points of each replicate for the first trial of the trained density: half of the exploration.
    std::uint64_t first_sample() const {
        return problem_.evaluator.dimensions() == 1 ? explored_ : std::max(least_explored, explored_ / 2);
    }
    // Values of one size, with a possible spike elsewhere: only more points can decide.
    bool plateau() const {
        return problem_.evaluator.dimensions() > 1 && trainer_.effective_share() > even_values;
    }
    // Does training begin by a search for peaks?
    Phase first_training() const { return trainer_.effective_share() < peaky ? Phase::search : Phase::train; }

    // Are uniform points expected to converge soon? Their error falls faster than 1 / n for what is smooth.
    bool uniform_will_do(const StepRequest& request) const {
        if (!request.targeted() || misses_a_peak(cube_, uniform_)) return false;
        // A trained density cannot follow the jumps of an indicator, and costs far more time per point.
        if (is_hit_indicator()) {
            const double expected = expected_rest_of_indicator(request);
            return expected <= static_cast<double>(request.max_evaluations) &&
                   (retrained_ > 0 || expected <= reach_of_indicators);
        }
        if (trainer_.effective_share() < trusted_exploration) return false;
        const bool even = trainer_.effective_share() > flat;
        const double expected =
            even ? uniform_.expected_rest(request) + static_cast<double>(uniform_.evaluations())
                 : static_cast<double>(uniform_.evaluations()) * std::max(1.0, uniform_.error_ratio(request));
        return expected <= (even ? uniform_reach : uniform_reach / 4);
    }

    // Were peaks found since the last search for them?
    bool has_new_peaks() const {
        return problem_.look && problem_.look->peaks.size() != known_peaks_ && retrained_ < max_retrainings;
    }
    // Searches again where the points so far do not explain them.
    StepOutcome consider_peaks() {
        known_peaks_ = problem_.look->peaks.size();
        if (phase_ == Phase::weighted ? misses_a_peak(trainer_.density(), weighted_)
                                      : misses_a_peak(cube_, uniform_)) {
            retrain(2 * static_cast<double>(trainer_.evaluations()), false);
            phase_ = Phase::search;
        }
        return StepOutcome::advanced;
    }

    StepOutcome search(const StepRequest& request) {
        const auto n = static_cast<std::uint64_t>(problem_.evaluator.dimensions());
        // If many points have large values, few searches show whether there are peaks at all.
        const bool narrow = trainer_.effective_share() < narrow_peaks;
        trainer_.find_peaks(std::min(request.max_evaluations / 4, (narrow ? 32 : 8) * (60 * n + 3 * n * n)),
                            narrow ? 5 : 2,
                            narrow && n > 1 && n <= most_surveyed ? survey_points * n * n : 0);
        phase_ = Phase::train;
        return StepOutcome::advanced;
    }

    StepOutcome train(const StepRequest& request) {
        if (request.max_evaluations < 2 * round_points_ || !trainer_.has_time_for(round_points_, request))
            return stop_training(request);
        if (!trainer_.round(round_points_, request)) return StepOutcome::cancelled;
        const double variance = trainer_.relative_variance();
        const bool stuck =
            trainer_.rounds() > 3 && variance != previous_variance_ && variance > 0.9 * previous_variance_;
        previous_variance_ = variance;
        // Larger rounds if more of the same size do not improve the fit.
        const double trained = static_cast<double>(trainer_.evaluations() - trainer_.search_evaluations() +
                                                   uniform_.evaluations());
        if (stuck || trained > 5 * static_cast<double>(round_points_))
            round_points_ = std::min(4 * round_points_, max_training_points);
        // A share of the allowed evaluations, larger if these are few; or of the expected cost of the target
        // with this density and the usual gain of Sobol' points.
        const double all = static_cast<double>(request.max_evaluations) + trained;
        const double most = !request.targeted() && all >= enough_for_half ? all / 2 : all / 3;
        double allowed = std::max(fixed_training_share * all, std::min(most, least_training));
        if (request.relative_error > 0)
            allowed = std::min(allowed, settings_.training_share *
                                            std::pow(std::sqrt(variance) / request.relative_error, 1.4));
        allowed = std::max(allowed, training_goal_);
        if (request.targeted() && trainer_.uncovered_share() > DensityTrainer::uncovered_matters)
            allowed = std::max(allowed, 0.25 * all);
        if (trainer_.rounds() >= 2 &&
            (trained + static_cast<double>(round_points_) > allowed || trainer_.rounds() >= max_rounds))
            phase_ = Phase::weighted;
        return StepOutcome::advanced;
    }

    // The next phase's first step; if it fails, nothing changes.
    StepOutcome stop_training(const StepRequest& request) {
        phase_ = trainer_.rounds() > 0 ? Phase::weighted : Phase::uniform;
        try {
            const StepOutcome outcome = step(request);
            if (outcome != StepOutcome::advanced) phase_ = Phase::train;
            return outcome;
        } catch (...) {
            phase_ = Phase::train;
            throw;
        }
    }

    StepOutcome sample(const StepRequest& request, const MixtureDensity& density, std::uint64_t stream,
                       MixtureEstimate& estimate) {
        const std::uint64_t points = estimate.points();
        const std::uint64_t end =
            estimate.next_end(request, first_sample(), density.balanced_points(), step_points);
        if (end <= points) return StepOutcome::exhausted;
        // Training gets the uniform points drawn since the exploration.
        const bool keep = phase_ == Phase::uniform && trainer_.rounds() == 0 && request.targeted() &&
                          (end - points) * replicates() <= most_kept;
        SamplePoints drawn;
        auto added =
            sample_mixture(problem_.evaluator, density, hash_key(problem_.seed, stream), settings_.replicates,
                           points, end, keep ? &drawn : nullptr, request.cancel, device_.get());
        if (!added) return StepOutcome::cancelled;
        estimate.grow(*added, end);
        if (phase_ == Phase::weighted)
            choose_again(request, points == 0);
        else if (trainer_.rounds() == 0 && request.targeted() && trainer_.nonzero() >= enough_nonzero &&
                 estimate.error_ratio(request) > 1 && !uniform_will_do(request) &&
                 request.max_evaluations >= smallest_budget * training_points) {
            estimate.compare_anew(); // slower than expected
            if (keep) trainer_.start(std::move(drawn));
            phase_ = first_training();
        }
        return StepOutcome::advanced;
    }

    StepOutcome check(const StepRequest& request) {
        if (request.cancel && request.cancel->requested()) return StepOutcome::cancelled;
        const std::uint64_t trained = trainer_.evaluations();
        const bool again = retrained_ < max_retrainings && 4 * trained < request.max_evaluations;
        if (!check_.run(trainer_, weighted_, request, again)) return StepOutcome::exhausted;
        if (check_.unseen() > 0 && again) {
            retrain(2 * static_cast<double>(trained), false);
            if (uniform_will_do(request)) {
                uniform_.compare_anew();
                phase_ = Phase::uniform;
            }
        }
        return StepOutcome::advanced;
    }

    // The weighted samples end here: an estimate that went on with a density chosen by looking at them would be biased.
    // They stay a result of their own until the next density has had as many, if they missed nothing.
    void retrain(double goal, bool keeps) {
        ++retrained_;
        abandoned_evaluations_ += weighted_.evaluations();
        abandoned_non_finite_.merge(weighted_.sums().non_finite);
        const MixtureEstimate none(settings_.replicates, problem_.evaluator.components());
        if (!keeps)
            kept_ = none;
        else if (weighted_.points() >= kept_.points())
            kept_ = std::move(weighted_);
        weighted_ = none;
        check_ = {};
        training_goal_ = goal;
        phase_ = Phase::train;
    }

    // Returns to uniform points if they prove better; trains more if the target is much farther than
    // expected.
    void choose_again(const StepRequest& request, bool first) {
        const double ratio = weighted_.error_ratio(request);
        // For uneven integrands the error of uniform points is too uncertain for that.
        const bool sooner = request.targeted() && trainer_.effective_share() > flat &&
                            uniform_.expected_rest(request) < much_sooner * weighted_.expected_rest(request);
        const double more = static_cast<double>(uniform_.points()) / static_cast<double>(weighted_.points());
        const bool better = first && more <= 2 &&
                            uniform_.error_ratio(request) * (first_sample() < explored_ ? more : 1) < ratio;
        if (trainer_.effective_share() > trusted_exploration && (sooner || better) &&
            !misses_a_peak(cube_, uniform_)) {
            uniform_.compare_anew();
            phase_ = Phase::uniform;
            return;
        }
        // Training again takes more than one round.
        if (!request.targeted() || weighted_.points() < 4 * first_sample() || retrained_ >= max_retrainings ||
            !trainer_.has_time_for(2 * round_points_, request))
            return;
        const double sampled = static_cast<double>(weighted_.evaluations());
        const double left =
            std::min(sampled * (std::pow(ratio, 1.5) - 1), static_cast<double>(request.max_evaluations));
        const double trained = static_cast<double>(trainer_.evaluations());
        const bool far = settings_.training_share * left > 2 * trained && sampled < left;
        // Unexpectedly large weights: the density misses a part of the integrand.
        const bool surprised = ratio <= surprise_matters && weighted_.has_surprising_weights() &&
                               4 * trained < static_cast<double>(request.max_evaluations);
        if (!far && !surprised) return;
        retrain(surprised ? 2 * trained : settings_.training_share * left, !surprised);
    }

    void add_warnings(const MixtureEstimate& estimate, bool heavy, bool lost, Tally& tally) const {
        auto warn = [&tally](std::string text) { tally.warnings.push_back(std::move(text)); };
        if (lost) warn("the trained density lost what the exploring points had seen");
        if (trainer_.nonzero() == 0 && tally.value[0] == 0)
            warn("the integrand was zero at every point; a narrow peak may have been missed");
        else if (trainer_.nonzero() < enough_nonzero && phase_ == Phase::weighted && known_peaks_ > 0 &&
                 !(problem_.look && problem_.look->found_by_chance))
            tally.notes.push_back(outside_of_peaks());
        else if (trainer_.nonzero() < enough_nonzero) {
            tally.sparse = true;
            warn("only " + std::to_string(trainer_.nonzero()) +
                 " of the exploring points saw anything but zero; other places may have been missed");
        }
        if (phase_ == Phase::weighted && problem_.evaluator.dimensions() > 1 && trainer_.peaks() > 0 &&
            trainer_.effective_share() < narrow_peaks)
            tally.notes.push_back(other_peaks());
        if (heavy) warn("one sample makes up much of the standard error; the weights have a heavy tail");
        if (estimate.one_replicate_stands_out())
            warn("one replicate stands far from the others; the error may be underestimated");
        if (tally.degrees_of_freedom > 0 &&
            chi_squared_p_value(tally.chi_squared, tally.degrees_of_freedom) < disagreement)
            warn("the training rounds disagree with the result");
    }

    // What a search for peaks excludes: where all of the integral lies in them, points elsewhere tell of others only by
    // the slopes that lead there.
    std::string other_peaks() const {
        constexpr double rule_of_three = 3; // 5 % of probability
        std::array<char, 160> text;
        std::snprintf(
            text.data(), text.size(),
            "%s found by climbing from %.0f points; another to which less than 1/%.0f of the domain "
            "slopes would be missed in 5 %% of cases",
            trainer_.peaks() == 1 ? "one peak was"
                                  : (std::to_string(trainer_.peaks()) + " peaks were").c_str(),
            static_cast<double>(trainer_.searched_points()),
            static_cast<double>(trainer_.searched_points()) / rule_of_three);
        return text.data();
    }

    // What uniform points exclude where all but the known peaks is zero.
    std::string outside_of_peaks() const {
        constexpr double rule_of_three = 3; // 5 % of probability
        std::array<char, 160> text;
        std::snprintf(text.data(), text.size(),
                      "nearly all of the domain is zero but for peaks that were seen by chance or scale; "
                      "others in less "
                      "than 1/%.0f of it would be missed in 5 %% of cases",
                      static_cast<double>(uniform_.all_points()) / rule_of_three);
        return text.data();
    }

    Problem problem_;
    Adaptive settings_;
    std::unique_ptr<DeviceValues> device_; // null: the processor
    std::uint64_t explored_;               // points of each replicate that the exploration takes
    DensityTrainer trainer_;
    MixtureDensity cube_; // uniform
    Phase phase_ = Phase::explore;
    double previous_variance_ = std::numeric_limits<double>::infinity();
    std::uint64_t round_points_; // of the next round of training
    double training_goal_ = 0;   // evaluations that training may always take
    int retrained_ = 0;
    std::uint64_t known_peaks_ = 0; // of the look, when peaks were last searched for
    DensityCheck check_;
    std::uint64_t abandoned_evaluations_ = 0;
    NonFiniteCount abandoned_non_finite_;
    MixtureEstimate uniform_, weighted_;
    MixtureEstimate kept_; // of the density before; without points: none
};

} // namespace

std::unique_ptr<Estimator> Adaptive::estimator(const Problem& problem) const {
    if (replicates < 4 || replicates > 4096) throw Error("adaptive", "expected 4 to 4096 replicates");
    if (!(uniform_share > 0 && uniform_share < 1))
        throw Error("adaptive", "expected a uniform share between 0 and 1");
    if (!(training_share > 0 && training_share < 1))
        throw Error("adaptive", "expected a training share between 0 and 1");
    if (problem.evaluator.dimensions() > sobol_dimensions)
        throw Error("adaptive", "expected at most " + std::to_string(sobol_dimensions) + " dimensions, got " +
                                    std::to_string(problem.evaluator.dimensions()));
    return std::make_unique<AdaptiveEstimator>(problem, *this);
}

} // namespace montelux
