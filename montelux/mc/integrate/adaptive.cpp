#include "montelux/mc/integrate/adaptive.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "montelux/mc/integrate/adaptive/density_trainer.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/sobol.h"

namespace montelux {
namespace {

constexpr std::uint64_t units = MixtureDensity::units;
constexpr std::uint64_t training_points = 2048;      // of a round, at first
constexpr std::uint64_t max_training_points = 65536; // of a round
constexpr double heavy_weight = 5;                   // times the mean, of one sample,
constexpr double heavy_influence = 0.5;              // and times the standard error, of what it adds
constexpr int max_rounds = 24;
constexpr int max_retrainings = 4;
constexpr double fixed_training_share = 0.1; // of a fixed number of evaluations,
constexpr double least_training = 20000;     // or so many, if they are no more than a third
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t enough_nonzero = 16;        // points that must see anything before training begins,
constexpr std::uint64_t most_exploration = 1 << 20; // or evaluations without
constexpr double peaky = 0.01; // effective share of exploring points below which peaks are searched for
constexpr double trusted_exploration = 0.05; // the same, above which the error of uniform points is believed
constexpr double flat = 0.6; // the same, of integrands that uniform points are likely to be best for
constexpr double uniform_reach = 24576; // evaluations within which uniform points may be expected to arrive
constexpr std::uint64_t step_points = 65536; // of each replicate in one step
constexpr std::uint64_t smallest_budget = 4; // rounds of training that must fit in for training to begin

// 2^k or 3 * 2^(k - 1): numbers of Sobol' points that divide the cube evenly; the next one above n.
std::uint64_t next_balanced(std::uint64_t n) {
    const std::uint64_t floor = std::bit_floor(n);
    return n < floor + floor / 2 ? floor + floor / 2 : 2 * floor;
}

class AdaptiveEstimator final : public Estimator {
  public:
    AdaptiveEstimator(const Problem& problem, const Adaptive& settings)
        : problem_(problem), settings_(settings),
          explored_(std::max<std::uint64_t>(
              128, std::bit_ceil(4 * static_cast<std::uint64_t>(problem.evaluator.dimensions())))),
          trainer_(problem, std::max(1, static_cast<int>(
                                            std::lround(settings.uniform_share * MixtureDensity::units)))),
          uniform_(problem.evaluator.dimensions()), round_points_(explored_ / 128 * training_points) {
        uniform_sums_.sums = weighted_sums_.sums =
            ReplicateSums(settings.replicates, problem.evaluator.components());
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
            return sample(request, trainer_.density(), 2, weighted_sums_, weighted_points_);
        default:
            return sample(request, uniform_, 0, uniform_sums_, uniform_points_);
        }
    }

    Tally tally() const override {
        const bool weighted = phase_ == Phase::weighted && weighted_points_ > 0;
        const MixtureSums& sums = weighted ? weighted_sums_ : uniform_sums_;
        const std::uint64_t points = weighted ? weighted_points_ : uniform_points_;
        Tally tally;
        tally.evaluations = evaluations();
        tally.non_finite = trainer_.non_finite();
        tally.non_finite.merge(uniform_sums_.non_finite);
        tally.non_finite.merge(weighted_sums_.non_finite);
        tally.non_finite.merge(abandoned_non_finite_);
        tally.ready = before_points_ > 0 && (phase_ == Phase::uniform || weighted);
        if (points == 0) {
            const auto m = static_cast<std::size_t>(problem_.evaluator.components());
            tally.value.assign(m, 0.0);
            tally.standard_error.assign(m, infinity);
            return tally;
        }
        const Spread s = spread(sums, points, problem_.full_covariance);
        tally_mean(s.moments, tally);
        const std::size_t m = tally.value.size();
        for (std::size_t c = 0; c < m; ++c) tally.standard_error[c] *= s.inflation[c];
        for (std::size_t i = 0; i < tally.covariance.size(); ++i)
            tally.covariance[i] *= s.inflation[i / m] * s.inflation[i % m];
        if (weighted)
            for (const DensityTrainer::Check& check : trainer_.checks()) {
                const double variance = check.variance + tally.standard_error[0] * tally.standard_error[0];
                if (!(variance > 0)) continue;
                tally.chi_squared += std::pow(check.value - tally.value[0], 2) / variance;
                ++tally.degrees_of_freedom;
            }
        if (heavy(sums, points, tally.standard_error[0])) tally.ready = false;
        add_doubts(sums, points, tally);
        return tally;
    }

    void save(StateWriter& state) const override {
        state.put(static_cast<int>(phase_));
        state.put(previous_variance_);
        state.put(round_points_);
        state.put(training_goal_);
        state.put(retrained_);
        state.put(before_points_);
        state.put(before_errors_);
        state.put(abandoned_evaluations_);
        montelux::save(state, abandoned_non_finite_);
        trainer_.save(state);
        state.put(uniform_points_);
        uniform_sums_.save(state);
        state.put(weighted_points_);
        weighted_sums_.save(state);
    }
    void load(StateReader& state) override {
        phase_ = static_cast<Phase>(std::clamp(state.get<int>(), 0, static_cast<int>(Phase::uniform)));
        previous_variance_ = state.get_double();
        round_points_ = state.get_word();
        training_goal_ = state.get_double();
        retrained_ = state.get<int>();
        before_points_ = state.get_word();
        before_errors_ = state.get_doubles();
        if (before_points_ > 0 &&
            before_errors_.size() != static_cast<std::size_t>(problem_.evaluator.components()))
            throw Error("the saved state has another number of components");
        abandoned_evaluations_ = state.get_word();
        montelux::load(state, abandoned_non_finite_);
        trainer_.load(state);
        uniform_points_ = state.get_word();
        uniform_sums_.load(state);
        weighted_points_ = state.get_word();
        weighted_sums_.load(state);
    }

  private:
    enum class Phase { explore, search, train, weighted, uniform };

    std::uint64_t evaluations() const {
        return uniform_sums_.evaluations + weighted_sums_.evaluations + trainer_.evaluations() +
               abandoned_evaluations_;
    }
    std::uint64_t replicates() const { return static_cast<std::uint64_t>(settings_.replicates); }

    // Moments over replicates, with variances no lower than those of the step before allow: an error that
    // seems to fall faster than points of bounded variation make it fall was luck, and stopping there would
    // select luck.
    struct Spread {
        CovarianceMoments moments;
        std::vector<double> inflation; // of each component's standard error
    };
    Spread spread(const MixtureSums& sums, std::uint64_t points, bool full) const {
        Spread s{sums.sums.moments(points, full), {}};
        for (int c = 0; c < s.moments.components(); ++c) {
            double factor = 1;
            if (before_points_ > 0 && before_points_ < points) {
                const double fall =
                    std::pow(static_cast<double>(before_points_) / static_cast<double>(points), 1.5);
                const double least = before_errors_[static_cast<std::size_t>(c)] * fall;
                const double error = std::sqrt(s.moments.variance(c) / static_cast<double>(replicates()));
                if (error > 0) factor = std::clamp(least / error, 1.0, 3.0);
            }
            s.inflation.push_back(factor);
        }
        return s;
    }
    double error(const Spread& s, int c) const {
        return s.inflation[static_cast<std::size_t>(c)] *
               std::sqrt(s.moments.variance(c) / static_cast<double>(replicates()));
    }

    // How far the estimate is from its target: the largest quotient of error and tolerance over the
    // components; the relative error itself where there is no target.
    double error_ratio(const MixtureSums& sums, std::uint64_t points, const StepRequest& request) const {
        const Spread s = spread(sums, points, false);
        double ratio = 0;
        for (int c = 0; c < s.moments.components(); ++c) {
            const double size = std::abs(s.moments.mean(c));
            const double tolerance =
                targeted(request) ? std::max(request.absolute_error, request.relative_error * size) : size;
            if (error(s, c) > 0) ratio = std::max(ratio, error(s, c) / tolerance);
        }
        return ratio;
    }
    static bool targeted(const StepRequest& request) {
        return request.relative_error > 0 || request.absolute_error > 0;
    }

    // Goes on, doubling, while hardly any point sees anything.
    StepOutcome explore(const StepRequest& request) {
        std::uint64_t points = uniform_points_ == 0 ? explored_ : uniform_points_;
        points = std::min(points, request.max_evaluations / replicates() / units * units);
        if (points == 0 && uniform_points_ == 0)
            points = request.max_evaluations / replicates(); // too few for balance
        if (points == 0) return StepOutcome::exhausted;
        SamplePoints drawn;
        auto sums =
            sample_mixture(problem_.evaluator, uniform_, hash_key(problem_.seed, 0), settings_.replicates,
                           uniform_points_, uniform_points_ + points, &drawn, request.cancel);
        if (!sums) return StepOutcome::cancelled;
        uniform_sums_.merge(*sums);
        uniform_points_ += points;
        trainer_.start(std::move(drawn));
        const std::uint64_t left = request.max_evaluations - sums->evaluations;
        const bool room = uniform_points_ >= explored_ && left >= smallest_budget * training_points;
        if (!room || uniform_will_do(request))
            phase_ = Phase::uniform;
        else if (trainer_.nonzero() >= enough_nonzero || uniform_sums_.evaluations >= most_exploration)
            phase_ = trainer_.nonzero() == 0              ? Phase::uniform
                     : trainer_.effective_share() < peaky ? Phase::search
                                                          : Phase::train;
        return StepOutcome::advanced;
    }

    // Are uniform points expected to arrive soon? Their error falls faster than 1 / n for what is smooth.
    bool uniform_will_do(const StepRequest& request) const {
        if (!targeted(request) || trainer_.effective_share() < trusted_exploration) return false;
        const double ratio = error_ratio(uniform_sums_, uniform_points_, request);
        const bool even = trainer_.effective_share() > flat;
        return static_cast<double>(uniform_sums_.evaluations) *
                   std::pow(std::max(1.0, ratio), even ? 1 / 1.2 : 1) <=
               (even ? uniform_reach : uniform_reach / 4);
    }

    StepOutcome search(const StepRequest& request) {
        const auto n = static_cast<std::uint64_t>(problem_.evaluator.dimensions());
        trainer_.find_peaks(std::min(request.max_evaluations / 4, 12 * (60 * n + 3 * n * n)));
        phase_ = Phase::train;
        return StepOutcome::advanced;
    }

    StepOutcome train(const StepRequest& request) {
        if (request.max_evaluations < 2 * round_points_) return stop_training(request);
        if (!trainer_.round(round_points_, request.cancel)) return StepOutcome::cancelled;
        const double variance = trainer_.relative_variance();
        const bool stuck = trainer_.rounds() > 3 && variance > 0.9 * previous_variance_;
        previous_variance_ = variance;
        // Larger rounds where more of the same size change nothing.
        const double trained = static_cast<double>(trainer_.evaluations() + uniform_sums_.evaluations);
        if (stuck || trained > 5 * static_cast<double>(round_points_))
            round_points_ = std::min(4 * round_points_, max_training_points);
        // A share of the evaluations there are, a greater one of few; or of what the target will cost with
        // this density, if the Sobol' points help as they usually do.
        const double all = static_cast<double>(request.max_evaluations) + trained;
        double allowed = std::max(fixed_training_share * all, std::min(all / 3, least_training));
        if (request.relative_error > 0)
            allowed = std::min(allowed, settings_.training_share *
                                            std::pow(std::sqrt(variance) / request.relative_error, 1.4));
        allowed = std::max(allowed, training_goal_);
        if (trainer_.rounds() >= 2 &&
            (trained + static_cast<double>(round_points_) > allowed || trainer_.rounds() >= max_rounds))
            phase_ = Phase::weighted;
        return StepOutcome::advanced;
    }

    // The next phase's first step; if that is not made, nothing changes.
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
                       MixtureSums& sums, std::uint64_t& points) {
        const std::uint64_t affordable = points + request.max_evaluations / replicates();
        const double ratio = points > 0 ? error_ratio(sums, points, request) : 0;
        std::uint64_t goal = points == 0 ? explored_ : next_balanced(points);
        if (points > 0 && targeted(request)) {
            // No further than the target is expected to need, but at most twice as far.
            const double needed = static_cast<double>(points) * std::min(2.0, ratio);
            while (static_cast<double>(next_balanced(goal)) <= needed) goal = next_balanced(goal);
        } else if (points > 0) {
            while (next_balanced(goal) <= std::min(2 * points, affordable)) goal = next_balanced(goal);
        }
        while (goal > affordable && goal > points) { // the largest balanced number that can be paid
            const std::uint64_t floor = std::bit_floor(goal);
            goal = goal > floor ? floor : floor / 4 * 3;
        }
        goal = goal / units * units;
        if (goal <= points) return StepOutcome::exhausted;
        const std::uint64_t end = std::min(goal, (points / units + step_points / units) * units);
        auto added = sample_mixture(problem_.evaluator, density, hash_key(problem_.seed, stream),
                                    settings_.replicates, points, end, nullptr, request.cancel);
        if (!added) return StepOutcome::cancelled;
        if (points > 0) {
            const Spread s = spread(sums, points, false);
            std::vector<double> errors;
            for (int c = 0; c < s.moments.components(); ++c) errors.push_back(error(s, c));
            before_errors_ = std::move(errors);
        }
        before_points_ = points;
        const bool first = points == 0;
        sums.merge(*added);
        points = end;
        if (phase_ == Phase::weighted)
            choose_again(request, first);
        else if (trainer_.rounds() == 0 && targeted(request) && trainer_.nonzero() >= enough_nonzero &&
                 error_ratio(sums, points, request) > 1 && !uniform_will_do(request) &&
                 request.max_evaluations >= smallest_budget * training_points) {
            before_points_ = 0; // slower than expected
            phase_ = Phase::train;
        }
        return StepOutcome::advanced;
    }

    // Uniform points where they prove better; more training where the target is much farther than was
    // expected.
    void choose_again(const StepRequest& request, bool first) {
        const double ratio = error_ratio(weighted_sums_, weighted_points_, request);
        if (first && trainer_.effective_share() > trusted_exploration &&
            uniform_points_ == weighted_points_ &&
            error_ratio(uniform_sums_, uniform_points_, request) < ratio) {
            before_points_ = 0;
            phase_ = Phase::uniform;
            return;
        }
        if (!targeted(request) || weighted_points_ < 4 * explored_ || retrained_ >= max_retrainings) return;
        const double sampled = static_cast<double>(weighted_sums_.evaluations);
        const double left =
            std::min(sampled * (std::pow(ratio, 1.5) - 1), static_cast<double>(request.max_evaluations));
        const double trained = static_cast<double>(trainer_.evaluations());
        if (!(settings_.training_share * left > 2 * trained && sampled < left)) return;
        // These samples are given up: an estimate that joined densities chosen by what was seen would be
        // biased.
        ++retrained_;
        abandoned_evaluations_ += weighted_sums_.evaluations;
        abandoned_non_finite_.merge(weighted_sums_.non_finite);
        weighted_sums_ = {};
        weighted_sums_.sums = ReplicateSums(settings_.replicates, problem_.evaluator.components());
        weighted_points_ = before_points_ = 0;
        training_goal_ = settings_.training_share * left;
        phase_ = Phase::train;
    }

    // Does one sample make up a good part of the error? Then others like it were probably not drawn yet.
    bool heavy(const MixtureSums& sums, std::uint64_t points, double error) const {
        // Of uniform points the best may weigh much, and yet be no surprise.
        if (phase_ != Phase::weighted) return false;
        const double n = static_cast<double>(points * replicates());
        double size = 0;
        for (const MixtureSums::Channel& c : sums.channels) size += std::abs(c.sum) / n;
        return sums.largest > heavy_weight * size && sums.largest > heavy_influence * n * error;
    }

    void add_doubts(const MixtureSums& sums, std::uint64_t points, Tally& tally) const {
        const int m = settings_.replicates;
        if (trainer_.nonzero() == 0 && tally.value[0] == 0)
            tally.doubts.push_back(
                "the integrand was zero at every point; a narrow peak may have been missed");
        else if (trainer_.nonzero() < enough_nonzero)
            tally.doubts.push_back(
                "only " + std::to_string(trainer_.nonzero()) +
                " of the exploring points saw anything but zero; other places may have been missed");
        if (heavy(sums, points, tally.standard_error[0]))
            tally.doubts.push_back(
                "one sample makes up much of the standard error; the weights have a heavy tail");
        // Of normal replicates one alone hardly ever makes up three quarters of the spread.
        double squares = 0, greatest = 0;
        for (int r = 0; r < m; ++r) {
            const double deviation = sums.sums.sum(r, 0) / static_cast<double>(points) - tally.value[0];
            squares += deviation * deviation;
            greatest = std::max(greatest, deviation * deviation);
        }
        if (m >= 8 && greatest > 0.8 * squares)
            tally.doubts.push_back(
                "one replicate stands far from the others; the error may be underestimated");
        if (tally.degrees_of_freedom > 0 &&
            chi_squared_p_value(tally.chi_squared, tally.degrees_of_freedom) < 1e-4)
            tally.doubts.push_back("the training rounds disagree with the result");
    }

    Problem problem_;
    Adaptive settings_;
    std::uint64_t explored_; // points of each replicate that the exploration takes
    DensityTrainer trainer_;
    MixtureDensity uniform_;
    Phase phase_ = Phase::explore;
    double previous_variance_ = infinity;
    std::uint64_t round_points_; // of the next round of training
    double training_goal_ = 0;   // evaluations that training may take in any case
    int retrained_ = 0;
    std::uint64_t before_points_ = 0; // the estimate's points before the last step, and its errors
    std::vector<double> before_errors_;
    std::uint64_t abandoned_evaluations_ = 0;
    NonFiniteCount abandoned_non_finite_;
    MixtureSums uniform_sums_, weighted_sums_;
    std::uint64_t uniform_points_ = 0, weighted_points_ = 0; // of each replicate
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
