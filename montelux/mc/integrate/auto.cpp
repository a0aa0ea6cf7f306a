#include "montelux/mc/integrate/auto.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/cubature/cubature.h"
#include "montelux/mc/integrate/cubature/cubature_rules.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/trained/unit_density.h"
#include "montelux/mc/integrate/witness/first_look.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/sobol.h"

namespace montelux {
namespace {

constexpr int region_counts = 4; // with fewer variables a region is affordable even with few evaluations
constexpr int cubature_dimensions = 8; // with more, a region costs more points than a first step of sampling
constexpr double least_pilot = 1500;   // evaluations of cubature before it is judged,
constexpr double pilot_share = 0.25;   // or this share of what sampling is expected to need,
constexpr double pilot_of_all = 0.125; // or of a fixed number of evaluations; the same for sampling after it
// Errors that fall as a smaller power of the evaluations indicate a pole without an integral: the halves that
// contain it converge on it.
constexpr double slowest_of_one_variable = 0.25;
constexpr double cautious_rate = 0.5;  // the same power, where few evaluations are judged after the first
constexpr double largest_first = 0.25; // share of a fixed number of evaluations that one region may take
// With so few evaluations left, in regions, the first one decides: cubature is given up where not even errors
// falling by this power of the evaluations would do.
constexpr double few_regions = 32, hopeful_rate = 2;
constexpr double patience_of_one =
    100; // factor of the evaluations, or of the error, that rules may need in one variable
constexpr std::uint64_t patience = 60000; // evaluations of sampling before cubature gets a second chance,
constexpr double second_share = 0.2;      // and the share of sampling's evaluations that it then gets
// A localised result is compared with sampling at a multiple of the target, within these relative errors.
constexpr double finest_comparison = 1e-5, coarsest_comparison = 0.03;
constexpr double comparable = 1.5; // largest ratio of sampling's error to cubature's when both are compared
constexpr double agreeing = 1, disagreeing = 2.5; // joint standard errors; in between sampling goes on
constexpr double surprising_growth = 4;           // growth of the error that makes a new problem

// What Adaptive needs for a relative error, roughly, as measured on Genz's families in 5 and 8 dimensions
// (docs/integration.md): 10,000 evaluations for 1e-3, 35,000 for 1e-4.
double sampling_cost(double relative_error) { return 35000 * std::pow(1e-4 / relative_error, 0.55); }
// What it reaches. With few evaluations the error is smaller than this law says: measured as above 1 % with 1000,
// 0.14 % with 5000. With fewer variables rules are ahead, and the law errs on their side.
double sampling_error(double evaluations, int dimensions) {
    constexpr double few = 20000, rate_of_few = 1.17;
    auto many = [](double n) { return 1e-4 * std::pow(35000 / n, 1 / 0.55); };
    const double n = std::max(evaluations, 1.0);
    return n < few && dimensions >= region_counts ? many(few) * std::pow(few / n, rate_of_few) : many(n);
}

std::string printed(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", x);
    return text;
}

// An estimator that was chosen from the start, with its name and the reason.
class PickedEstimator final : public Estimator {
  public:
    PickedEstimator(std::unique_ptr<Estimator> estimator, std::string_view method, std::string reason)
        : estimator_(std::move(estimator)), method_(method), reason_(std::move(reason)) {}

    StepOutcome step(const StepRequest& request) override { return estimator_->step(request); }
    Tally tally() const override {
        Tally tally = estimator_->tally();
        tally.method = method_;
        tally.reason = reason_;
        return tally;
    }
    void save(StateWriter& state) const override { estimator_->save(state); }
    void load(StateReader& state) override { estimator_->load(state); }

  private:
    std::unique_ptr<Estimator> estimator_;
    std::string method_, reason_;
};

class AutoEstimator final : public Estimator {
  public:
    explicit AutoEstimator(const Problem& problem)
        : cubature_(Cubature{}.estimator(problem)), sampling_(Adaptive{}.estimator(problem)),
          look_(problem.look), dimensions_(problem.evaluator.dimensions()) {}

    StepOutcome step(const StepRequest& request) override {
        if (switched_) return step_both(request);
        if (diverges_) return StepOutcome::finished;
        if (comparing_) return compare(request);
        const bool targeted = request.targeted();
        if (!targeted && cubature_->tally().evaluations == 0 && region_is_too_dear(request.max_evaluations)) {
            const StepOutcome outcome = sampling_->step(request);
            if (outcome != StepOutcome::advanced) return outcome;
            give_up("too few evaluations for a first region of cubature");
            rules_end_ = true;
            return outcome;
        }
        const std::uint64_t before = cubature_->tally().evaluations;
        const StepOutcome outcome = cubature_->step(request);
        if (outcome == StepOutcome::cancelled) return outcome;
        if (outcome == StepOutcome::advanced) {
            judge(request, before);
            return outcome;
        }
        // Cubature has finished. Sampling takes over if there is no result yet, or if many evaluations are
        // left and the target is open or the result has a warning; with fewer left it would give a worse
        // result.
        const Tally rule = cubature_->tally();
        const std::uint64_t spent = rule.evaluations;
        const bool open = outcome == StepOutcome::finished && (targeted || !rule.warnings.empty()) &&
                          request.max_evaluations > spent;
        if (spent > 0 && !open) return outcome;
        if (outcome == StepOutcome::finished && rule.at_limit) {
            reason_ = "no further evaluations would help";
            return outcome;
        }
        give_up("cubature could do no more");
        const StepOutcome other = sampling_->step(request);
        if (other != StepOutcome::advanced) switched_ = false;
        return other == StepOutcome::advanced ? other : outcome;
    }

    // Sampling goes first; if it takes long, cubature gets a share of the evaluations, since its predicted
    // cost was a guess from its first regions.
    StepOutcome step_both(const StepRequest& request) {
        const bool targeted = request.targeted();
        const std::uint64_t rules = cubature_->tally().evaluations;
        const std::uint64_t sampled = sampling_->tally().evaluations;
        if (!targeted && !rules_end_ && !returned_ && sampling_is_worse(request)) {
            switched_ = false;
            returned_ = true;
            reason_ = "sampling did worse than cubature before it";
            return step(request);
        }
        const bool chance = targeted && !rules_end_;
        if (chance && sampled >= patience &&
            static_cast<double>(rules) < second_share * static_cast<double>(sampled))
            return step_rules(request);
        const StepOutcome outcome = sampling_->step(request);
        const bool left = outcome == StepOutcome::exhausted || outcome == StepOutcome::finished;
        return left && chance ? step_rules(request) : outcome;
    }

    // Without a target: after its share of the evaluations, and as many as cubature had, can sampling still become as good
    // as cubature was?
    bool sampling_is_worse(const StepRequest& request) const {
        const Tally rule = cubature_->tally(), sampled = sampling_->tally();
        const double made = static_cast<double>(sampled.evaluations);
        const double share = made / (made + static_cast<double>(request.max_evaluations));
        if (share < pilot_of_all || sampled.evaluations < rule.evaluations || !rule.warnings.empty() ||
            !has_errors(sampled))
            return false;
        bool worse = true;
        for (std::size_t c = 0; c < rule.value.size(); ++c)
            worse = worse && rule.standard_error[c] < share * sampled.standard_error[c];
        return worse;
    }

    StepOutcome step_rules(const StepRequest& request) {
        if (!rules_arrived(request)) {
            const StepOutcome outcome = cubature_->step(request);
            if (outcome == StepOutcome::cancelled) return outcome;
            if (outcome != StepOutcome::advanced) {
                rules_end_ = true;
                return sampling_->step(request);
            }
            if (!rules_arrived(request)) return outcome;
        }
        // Regions that converge on a singularity may fool both the rules and their check: sampling must have
        // nearly as small an error.
        StepRequest nearly = request;
        nearly.relative_error *= comparable;
        nearly.absolute_error *= comparable;
        const Agreement found = agreement(nearly);
        if (found == Agreement::unknown) return sampling_->step(request);
        if (found == Agreement::disagree) {
            rules_end_ = true;
            return sampling_->step(request);
        }
        switched_ = false;
        agreed_ = true;
        reason_ = "cubature and sampling in turns: cubature arrived first";
        return StepOutcome::advanced;
    }

    bool rules_arrived(const StepRequest& request) const {
        const Tally rule = cubature_->tally();
        bool arrived = rule.ready && rule.warnings.empty();
        for (std::size_t c = 0; c < rule.value.size(); ++c)
            arrived = arrived && rule.standard_error[c] <= request.tolerance(c, rule.value[c]);
        return arrived;
    }

    enum class Agreement : std::uint8_t { unknown, agree, disagree };
    // Whether the values of both methods agree; unknown while sampling's error exceeds the request's targets and
    // a multiple of cubature's, or tells too little.
    Agreement agreement(const StepRequest& request) const {
        const Tally rule = cubature_->tally(), sampled = sampling_->tally();
        const std::shared_ptr<const UnitDensity> density = sampling_->sampled_density();
        std::vector<Unreached> missed(rule.value.size());
        if (look_)
            missed = unreached(look_->slow, missed.size(), density.get(),
                               static_cast<double>(sampled.evaluations));
        bool agree = true;
        for (std::size_t c = 0; c < rule.value.size(); ++c) {
            const double error = std::hypot(sampled.standard_error[c], missed[c].mass);
            if (!(error <=
                  std::max(request.tolerance(c, rule.value[c]), comparable * rule.standard_error[c])))
                return Agreement::unknown;
            const double joint = std::hypot(error, rule.standard_error[c]),
                         difference = std::abs(rule.value[c] - sampled.value[c]);
            if (difference > disagreeing * joint) return Agreement::disagree;
            agree = agree && difference <= agreeing * joint;
        }
        return agree ? Agreement::agree : Agreement::unknown;
    }

    // A peak too narrow for the random check is compared with a rough result of sampling, which searches for
    // peaks.
    StepOutcome compare(const StepRequest& request) {
        StepRequest rough = request;
        const double multiple =
            request.relative_error > 0 ? comparable * request.relative_error : coarsest_comparison;
        rough.relative_error =
            std::max(request.relative_error, std::clamp(multiple, finest_comparison, coarsest_comparison));
        const StepOutcome outcome = sampling_->step(rough);
        if (outcome == StepOutcome::cancelled) return outcome;
        const bool over = outcome != StepOutcome::advanced;
        if (!over && !sampling_->tally().ready) return outcome;
        StepRequest twice = rough;
        twice.relative_error *= 2;
        twice.absolute_error = 0;
        const Agreement found = agreement(twice);
        agreed_ = found == Agreement::agree;
        if (agreed_) reason_ = "cubature converges, and sampling agrees";
        if (found == Agreement::disagree) {
            give_up("cubature and sampling disagree");
            rules_end_ = true;
        }
        comparing_ = !over && found == Agreement::unknown;
        return over && (agreed_ || switched_) ? StepOutcome::advanced : outcome;
    }

    Tally tally() const override {
        const Tally rule = cubature_->tally();
        if (!switched_ || !has_errors(sampling_->tally())) {
            Tally tally = rule;
            tally.method = Cubature::name;
            tally.reason = reason_;
            const Tally sampled = sampling_->tally();
            tally.evaluations += sampled.evaluations;
            tally.non_finite.merge(sampled.non_finite);
            if (diverges_)
                tally.warnings.push_back(
                    "the error does not fall where values are not finite; the integral may not exist");
            // A cubature with a warning is replaced by sampling.
            tally.ready = tally.ready && tally.warnings.empty() && (agreed_ || !tally.localised);
            tally.localised = tally.localised && (!agreed_ || sampled.sparse);
            if (agreed_) tally.notes.insert(tally.notes.end(), sampled.notes.begin(), sampled.notes.end());
            return tally;
        }
        Tally tally = sampling_->tally();
        tally.method = Adaptive::name;
        tally.reason = reason_;
        tally.evaluations += rule.evaluations;
        NonFiniteCount all = rule.non_finite;
        all.merge(tally.non_finite);
        tally.non_finite = std::move(all);
        return tally;
    }

    std::shared_ptr<const UnitDensity> density() const override {
        return switched_ ? sampling_->density() : nullptr;
    }
    std::shared_ptr<const UnitDensity> sampled_density() const override {
        return switched_ ? sampling_->sampled_density() : nullptr;
    }
    void save(StateWriter& state) const override {
        state.put(std::uint64_t{switched_} | std::uint64_t{diverges_} << 1 | std::uint64_t{rules_end_} << 2 |
                  std::uint64_t{comparing_} << 3 | std::uint64_t{agreed_} << 4 |
                  std::uint64_t{returned_} << 5);
        state.put(reason_);
        state.put(ratios_);
        state.put(costs_);
        state.put(begin_);
        cubature_->save(state);
        sampling_->save(state);
    }
    void load(StateReader& state) override {
        const std::uint64_t flags = state.get_word();
        switched_ = (flags & 1) != 0;
        diverges_ = (flags & 2) != 0;
        rules_end_ = (flags & 4) != 0;
        comparing_ = (flags & 8) != 0;
        agreed_ = (flags & 16) != 0;
        returned_ = (flags & 32) != 0;
        reason_ = state.get_text();
        ratios_ = state.get_doubles();
        costs_ = state.get_doubles();
        begin_ = state.get_double();
        if (ratios_.size() != costs_.size()) throw Error("the saved state is damaged");
        cubature_->load(state);
        sampling_->load(state);
    }

  private:
    static bool has_errors(const Tally& tally) {
        return std::ranges::all_of(tally.standard_error, [](double error) { return std::isfinite(error); });
    }

    bool region_is_too_dear(std::uint64_t max_evaluations) const {
        return dimensions_ >= region_counts && static_cast<double>(genz_malik_7(dimensions_).points()) >
                                                   largest_first * static_cast<double>(max_evaluations);
    }
    bool one_variable() const { return dimensions_ == 1; }

    void give_up(std::string why) {
        switched_ = true;
        reason_ = std::move(why);
    }

    // Will cubature reach the target before sampling would?
    void judge(const StepRequest& request, std::uint64_t before) {
        const Tally tally = cubature_->tally();
        const bool targeted = request.targeted();
        double ratio = 0, tightest = infinity;
        for (std::size_t c = 0; c < tally.value.size(); ++c) {
            const double size = request.size(c, tally.value[c]);
            if (targeted && std::isinf(tally.standard_error[c])) continue; // a part of it is searched for
            const double tolerance = targeted ? request.tolerance(c, tally.value[c]) : size;
            if (tally.standard_error[c] > 0) ratio = std::max(ratio, tally.standard_error[c] / tolerance);
            if (size > 0) tightest = std::min(tightest, tolerance / size);
        }
        const double cost = static_cast<double>(tally.evaluations - tally.check_evaluations);
        // After a surprise of the random check the earlier errors do not predict how fast the error falls.
        if (!ratios_.empty() && ratio > surprising_growth * std::max(1.0, ratios_.back())) {
            ratios_.clear();
            costs_.clear();
            begin_ = cost;
        }
        ratios_.push_back(ratio);
        costs_.push_back(cost);
        reason_ = "cubature converges";
        if (targeted && ratio <= 1) {
            // A target reached with a warning does not count.
            if (!tally.warnings.empty() && tally.ready) give_up("cubature warns: " + tally.warnings.front());
            comparing_ = !switched_ && tally.ready && tally.localised && !agreed_;
            return;
        }
        const double spent = cost - begin_;
        const double rate = falling_rate(targeted ? 1 : cautious_rate);
        if (targeted) {
            // Rules are at their best in one variable.
            const double alternative =
                sampling_cost(std::min(1.0, tightest)) * (one_variable() ? patience_of_one : 1);
            if (spent < std::max(least_pilot, pilot_share * alternative)) return;
            const double needed = spent * std::pow(ratio, 1 / std::max(rate, 0.05));
            if (needed > alternative && one_variable() && tally.non_finite.count + tally.singular > 0 &&
                rate < slowest_of_one_variable) {
                diverges_ = true;
                reason_ = "cubature does not converge";
            } else if (needed > alternative)
                give_up("after " + printed(cost) + " evaluations cubature seemed to need " + printed(needed) +
                        ", sampling about " + printed(alternative));
            return;
        }
        const double left =
            static_cast<double>(request.max_evaluations) - static_cast<double>(tally.evaluations - before);
        const double alternative = sampling_error(left, dimensions_);
        const bool decisive =
            dimensions_ >= region_counts && ratios_.size() == 1 && left < few_regions * spent;
        const bool hopeless =
            decisive && ratio * std::pow(spent / (spent + left), hopeful_rate) > alternative;
        // Few evaluations are not worth a long pilot.
        const double pilot = std::max(std::min(least_pilot, 0.25 * left), pilot_of_all * (spent + left));
        if (returned_ || (spent < pilot && !hopeless)) return;
        const double reached = ratio * std::pow(spent / (spent + left), hopeless ? hopeful_rate : rate);
        if (std::isinf(reached))
            give_up("cubature's value is still zero");
        else if (reached > alternative && !(one_variable() && reached < patience_of_one * alternative))
            give_up("cubature seemed to reach a relative error of " + printed(reached) +
                    ", sampling one of " + printed(alternative));
    }

    // Exponent p of error ~ evaluations^-p, between now and when half as many had been made; `unknown`
    // before.
    double falling_rate(double unknown) const {
        std::size_t i = costs_.size() - 1;
        while (i > 0 && costs_[i] - begin_ > 0.5 * (costs_.back() - begin_)) --i;
        if (i + 1 == costs_.size() || !(costs_[i] < costs_.back())) return unknown;
        if (!(ratios_[i] < infinity)) return unknown;
        return std::clamp(std::log(ratios_[i] / ratios_.back()) /
                              std::log((costs_.back() - begin_) / std::max(1.0, costs_[i] - begin_)),
                          0.0, 8.0);
    }

    std::unique_ptr<Estimator> cubature_, sampling_;
    const FirstLook* look_;
    int dimensions_;
    bool switched_ = false;
    bool comparing_ = false, agreed_ = false; // cubature with sampling
    bool rules_end_ = false;                  // cubature can do no more
    bool returned_ = false;                   // to cubature, for the rest of a fixed number of evaluations
    bool diverges_ = false;                   // neither method could do more
    std::string reason_;
    double begin_ = 0;                   // evaluations before the problem that is judged
    std::vector<double> ratios_, costs_; // of error to target, and evaluations, after each step of cubature
};

} // namespace

std::unique_ptr<Estimator> Auto::estimator(const Problem& problem) const {
    const int dimensions = problem.evaluator.dimensions();
    auto picked = [&](const auto& settings, int most, const char* what) {
        return std::make_unique<PickedEstimator>(settings.estimator(problem), settings.name,
                                                 std::to_string(dimensions) + " dimensions, " + what +
                                                     " at most " + std::to_string(most));
    };
    if (dimensions > sobol_dimensions)
        return picked(BasicMonteCarlo{}, sobol_dimensions, "adaptive sampling takes");
    if (dimensions > cubature_dimensions) return picked(Adaptive{}, cubature_dimensions, "cubature pays in");
    return std::make_unique<AutoEstimator>(problem);
}

} // namespace montelux
