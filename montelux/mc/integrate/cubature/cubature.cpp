#include "montelux/mc/integrate/cubature/cubature.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>

#include "montelux/mc/integrate/cubature/cubature_confirmation.h"
#include "montelux/mc/integrate/cubature/cubature_evaluation.h"
#include "montelux/mc/integrate/cubature/cubature_halving.h"
#include "montelux/mc/integrate/cubature/cubature_regions.h"
#include "montelux/mc/integrate/cubature/cubature_rules.h"
#include "montelux/mc/integrate/cubature/cubature_totals.h"
#include "montelux/mc/integrate/cubature/cubature_verification.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/witness/first_look.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// If all values are zero, the error is infinite until this many evaluations in this many regions.
constexpr std::uint64_t search_evaluations = 4096;
constexpr std::size_t search_regions = 16;
constexpr std::uint64_t regions_all_confirmed =
    32; // of one variable, of which all are halved to confirm the others
// Ratios of successive differences: the least that counts as slow (a jump has 1/2), and the largest that is assumed.
constexpr double slow_ratio = 0.6, slowest_ratio = 0.999;
// Differences depend on where in a region a pole lies.
constexpr double caution_of_series = 2, ratios_of_mean = 8;
// Points of a check that are expected in a part that it misses in 5 % of cases: e^(-0.6 n).
constexpr double often_missed = 5;
// Points after which an integrand with equal values at all of them is taken as constant.
constexpr std::uint64_t most_equal_values = 1 << 21;

class CubatureEstimator final : public Estimator {
  public:
    CubatureEstimator(const Problem& problem, std::uint64_t max_memory, std::uint64_t check_points)
        : problem_(problem), n_(problem.evaluator.dimensions()), m_(problem.evaluator.components()),
          regions_(n_, m_), max_regions_(max_memory / regions_.bytes_each()), totals_(m_), nonzero_(m_, 0),
          verification_(problem, check_points), check_points_(check_points), confirmation_(m_) {
        if (max_regions_ < 64)
            throw Error("cubature", "expected memory for at least 64 regions, " +
                                        std::to_string(64 * regions_.bytes_each()) + " bytes, got " +
                                        std::to_string(max_memory));
        // Regions start with the first rule and continue with the second if the integrand is smooth; the
        // coarse one is for regions where it is not.
        if (n_ == 1) {
            coarse_.emplace(coarse_rule_of_one_dimension());
            fine_.emplace(fine_rule_of_one_dimension());
        } else {
            coarse_.emplace(genz_malik_7(n_));
            fine_.emplace(n_ == 2   ? two_dimensional_rule()
                          : n_ == 3 ? three_dimensional_rule()
                                    : genz_malik_9(n_));
        }
    }

    StepOutcome step(const StepRequest& request) override {
        CubatureRegions fresh(n_, m_);
        std::vector<const SymmetricRule*> rules;
        std::vector<std::size_t> parents;
        // In one dimension, and in four and more, the cube is first evaluated by the cheaper rule, which may
        // suffice.
        if (!regions_.empty() && !verification_.recalled(regions_.count()) &&
            (reached(request) || (!request.targeted() && verification_.outgrown(regions_.count())))) {
            if (verification_.recall(regions_, totals_.value(), totals_.error(), request)) add_up();
            return StepOutcome::advanced;
        }
        verification_.update(regions_, totals_.value(), totals_.error(), request);
        const bool retry = regions_.count() == 1 && started_coarse() && !regions_.marks(0).rough && !refined_;
        const bool check = !regions_.empty() && !searching();
        if (check && verification_.due(regions_, totals_.value(), totals_.error(), evaluations_, request,
                                       reached(request)))
            return verify(request);
        const bool confirms = !retry && confirmation_.pending() && reached(request);
        if (regions_.empty() || retry) {
            fresh.add_cube();
            rules.push_back(regions_.empty() && started_coarse() ? &*coarse_ : &*fine_);
        } else {
            if (confirms)
                parents = regions_to_confirm(request);
            else if (is_beyond_division(request))
                return end(request);
            // Halving regions does not reduce the error of equal values.
            else if (searching() || reached(request) || !reaches(totals_.rule_error(), request))
                parents = regions_to_halve(regions_, scales(request), searching());
            if (regions_.count() + parents.size() > max_regions_)
                parents.resize(max_regions_ - regions_.count());
            if (parents.empty() && confirms) {
                confirmation_.skip();
                return StepOutcome::advanced;
            }
            if (parents.empty()) return end(request);
            for (std::size_t p : parents) rules.insert(rules.end(), 2, rule_for_halves(p));
        }
        ValueBuffer nested;
        if (parents.empty()) nested = nested_;
        fit_evaluations(rules, parents, request.max_evaluations + nested.count());
        if (rules.empty()) return StepOutcome::exhausted;
        for (std::size_t p : parents) fresh.add_halves(regions_, p);
        NonFiniteCount non_finite;
        std::vector<char> nonzero(nonzero_);
        std::vector<SymmetricRule::FaceValue> faces(parents.empty() ? 0 : rules.size() * components());
        std::uint64_t points = 0;
        for (const SymmetricRule* rule : rules) points += rule->points();
        const CubatureWork work{rules,
                                regions_,
                                parents,
                                fresh,
                                faces,
                                n_ == 1 && parents.empty() ? &nested : nullptr,
                                nested.count() > 0 && non_finite_.count > 0,
                                request.max_evaluations / 2 >= points};
        std::uint64_t shifted = 0;
        if (!evaluate_regions(problem_.evaluator, work, totals_.value(), non_finite, shifted, nonzero,
                              request.cancel))
            return StepOutcome::cancelled;

        evaluations_ += shifted;
        singular_ += shifted;
        for (const SymmetricRule* rule : rules) evaluations_ += rule->points();
        if (work.nested != nullptr) evaluations_ -= nested_.count();
        nested_ = std::move(nested);
        non_finite_.merge(non_finite);
        nonzero_ = std::move(nonzero);
        if (parents.empty()) {
            refined_ = !regions_.empty();
            correct_cube(regions_, fresh);
            regions_ = std::move(fresh);
            verification_.revisit(regions_);
        } else {
            if (confirms) {
                confirmation_.compare(regions_, parents, fresh, totals_.error());
                verification_.claim(totals_.error());
            }
            add_face_errors(work);
            replace(parents, fresh);
        }
        add_up();
        return StepOutcome::advanced;
    }

    Tally tally() const override {
        Tally tally;
        tally.statistical = false;
        tally.evaluations = evaluations_;
        tally.non_finite = non_finite_;
        tally.value.assign(m_, 0.0);
        tally.standard_error.assign(m_, std::numeric_limits<double>::infinity());
        if (regions_.empty()) {
            tally.ready = false;
            return tally;
        }
        tally.value = totals_.value();
        tally.standard_error = totals_.error();
        tally.absolute = totals_.absolute();
        if (searching())
            for (std::size_t c = 0; c < components(); ++c)
                if (nonzero_[c] == 0) tally.standard_error[c] = std::numeric_limits<double>::infinity();
        tally.ready = !searching() && verification_.verified(totals_.value()) && !confirmation_.pending() &&
                      (verification_.recalled(regions_.count()) || at_limit_);
        tally.at_limit = at_limit_;
        // Halving or the look finds a single feature of one variable; where chance found it, there may be more.
        const bool chance = problem_.look && problem_.look->found_by_chance;
        tally.localised = (n_ > 1 || chance || verification_.features() > 1) &&
                          verification_.evaluations() > 0 && verification_.blind();
        tally.check_evaluations = verification_.evaluations();
        tally.singular = singular_;
        tally.non_finite.merge(verification_.non_finite());
        if (m_ > 1 && verification_.knows_correlations())
            for (std::size_t a = 0; a < components(); ++a)
                for (std::size_t b = 0; b < components(); ++b)
                    tally.covariance.push_back(verification_.correlation(a, b) * totals_.error()[a] *
                                               totals_.error()[b]);
        add_warnings(tally);
        return tally;
    }

    void save(StateWriter& state) const override {
        regions_.save(state);
        state.put(evaluations_);
        state.put(refined_);
        for (int c = 0; n_ == 1 && c < m_; ++c) {
            const auto values = nested_.component(c);
            state.put(std::vector<double>(values.begin(), values.end()));
        }
        montelux::save(state, non_finite_);
        state.put_all(std::vector<std::uint64_t>(nonzero_.begin(), nonzero_.end()));
        totals_.save(state);
        state.put(at_limit_);
        state.put(singular_);
        verification_.save(state);
        confirmation_.save(state);
    }
    void load(StateReader& state) override {
        regions_.load(state);
        evaluations_ = state.get_word();
        refined_ = state.get<bool>();
        for (int c = 0; n_ == 1 && c < m_; ++c) {
            const std::vector<double> values = state.get_doubles();
            if (c == 0) nested_.resize(values.size(), m_);
            if (values.size() != nested_.count() || values.size() > fine_->points())
                throw Error("the saved values do not fit the components");
            std::ranges::copy(values, nested_.component(c).begin());
        }
        montelux::load(state, non_finite_);
        const auto nonzero = state.get_all<std::uint64_t>();
        nonzero_.assign(nonzero.begin(), nonzero.end());
        totals_.load(state);
        if (nonzero_.size() != components()) throw Error("the saved state has another number of components");
        at_limit_ = state.get<int>() != 0;
        singular_ = state.get_word();
        verification_.load(state, regions_.count());
        confirmation_.load(state);
        if (!regions_.empty()) add_up();
    }

  private:
    std::size_t components() const { return static_cast<std::size_t>(m_); }
    bool started_coarse() const { return n_ == 1 || n_ >= 4; }

    bool reached(const StepRequest& request) const { return reaches(totals_.error(), request); }
    bool reaches(const std::vector<double>& error, const StepRequest& request) const {
        if (!request.targeted()) return false;
        for (std::size_t c = 0; c < components(); ++c)
            if (!(error[c] <= request.tolerance(c, totals_.value()[c]))) return false;
        return true;
    }

    StepOutcome verify(const StepRequest& request) {
        verification_.note_features(regions_);
        const std::uint64_t points = verification_.points(regions_, totals_.value(), evaluations_, request);
        if (points == 0) {
            verification_.skip(totals_.value(), totals_.error());
            return request.max_evaluations > 0 ? StepOutcome::advanced : StepOutcome::exhausted;
        }
        const std::uint64_t made =
            verification_.run(regions_, totals_.value(), totals_.error(), points, request);
        if (made == 0) return StepOutcome::cancelled;
        evaluations_ += made;
        add_up();
        if ((n_ > 1 || regions_.count() > 1) && reached(request)) confirmation_.require(regions_);
        return StepOutcome::advanced;
    }

    // As many as cost about as much as a check; none if there are not enough evaluations left.
    std::vector<std::size_t> regions_to_confirm(const StepRequest& request) {
        const std::uint64_t pair = 2 * fine_->points();
        // In one variable regions are cheap, and random points show little of what oscillates: all, or a quarter of many.
        const std::uint64_t all = regions_.count(),
                            many = std::max(std::min(all, regions_all_confirmed), all / 4);
        const std::uint64_t wanted = n_ == 1 ? std::max(check_points_, many * pair) : check_points_;
        const std::uint64_t most = std::min(wanted, request.max_evaluations / 2) / pair;
        if (most == 0) return {};
        return confirmation_.choose(regions_, scales(request), most, problem_.seed);
    }

    // No region is left to halve. The error of equal values falls with the number of points.
    StepOutcome end(const StepRequest& request) {
        if (!verification_.recalled(regions_.count()) &&
            verification_.recall(regions_, totals_.value(), totals_.error(), request)) {
            add_up();
            return StepOutcome::advanced;
        }
        if (verification_.due(regions_, totals_.value(), totals_.error(), evaluations_, request, true))
            return verify(request);
        if (totals_.equal_values() && evaluations_ < most_equal_values && !reached(request) &&
            verification_.points(regions_, totals_.value(), evaluations_, request) > 0) {
            verification_.renew();
            return verify(request);
        }
        if (verification_.is_scattered() && !reached(request) &&
            verification_.may_grow(verification_.points(regions_, totals_.value(), evaluations_, request))) {
            verification_.renew();
            return verify(request);
        }
        at_limit_ = !verification_.is_scattered();
        for (std::size_t r = 0; r < regions_.count(); ++r)
            at_limit_ = at_limit_ && regions_.marks(r).exhausted;
        return StepOutcome::finished;
    }

    // Whether regions that cannot be halved have larger errors than the target.
    bool is_beyond_division(const StepRequest& request) const {
        if (!request.targeted()) return false;
        for (std::size_t c = 0; c < components(); ++c) {
            double sum = 0;
            for (std::size_t r = 0; r < regions_.count(); ++r)
                if (regions_.marks(r).indivisible) sum += regions_.error(r)[c];
            if (sum > request.tolerance(c, totals_.value()[c])) return true;
        }
        return false;
    }

    // All values of a component were zero so far: its part may not have been found.
    bool searching() const {
        const bool all_seen = std::ranges::all_of(nonzero_, [](char c) { return c != 0; });
        return !all_seen && (evaluations_ < search_evaluations || regions_.count() < search_regions);
    }

    const SymmetricRule* rule_for_halves(std::size_t parent) const {
        return n_ > 1 && regions_.marks(parent).rough ? &*coarse_ : &*fine_;
    }

    // Scale of each component's errors: its target, or its value if there is none. Zero for components that
    // are done while others are not.
    std::vector<double> scales(const StepRequest& request) const {
        std::vector<double> scale(components());
        bool all_reached = true;
        for (std::size_t c = 0; c < scale.size(); ++c) {
            const double value = totals_.value()[c];
            scale[c] = request.targeted() ? request.tolerance(c, value) : std::abs(value);
            if (scale[c] == 0) scale[c] = totals_.error()[c];
            all_reached = all_reached && totals_.error()[c] <= scale[c];
        }
        if (request.targeted() && !all_reached)
            for (std::size_t c = 0; c < scale.size(); ++c)
                if (totals_.error()[c] <= scale[c]) scale[c] = 0;
        return scale;
    }

    // Puts the halves in the place of the regions that were halved.
    void replace(const std::vector<std::size_t>& parents, CubatureRegions& halves) {
        totals_.begin_comparison();
        for (std::size_t p = 0; p < parents.size(); ++p) {
            const std::size_t parent = parents[p], a = 2 * p, b = a + 1;
            for (std::size_t c = 0; c < components(); ++c) {
                const double difference =
                    std::abs(regions_.value(parent)[c] - halves.value(a)[c] - halves.value(b)[c]);
                totals_.compare(c, regions_.error(parent)[c], difference);
                double &of_a = halves.error(a)[c], &of_b = halves.error(b)[c];
                if (const double sum = of_a + of_b; sum > 0) {
                    const double factor = 1 + difference / 4 / sum;
                    of_a *= factor;
                    of_b *= factor;
                    if (factor > 2) halves.marks(a).exhausted = halves.marks(b).exhausted = false;
                } else { // value of the region less that of its halves
                    of_a = of_b = difference / 2;
                    halves.marks(a).exhausted = halves.marks(b).exhausted = false;
                }
                // Towards a pole the differences of successive halvings fall as a geometric series, slowly for a power
                // close to -1: the larger half is off by the sum of those to come.
                const std::size_t half = of_a >= of_b ? a : b;
                CubatureRegions::Series series = regions_.series(parent, c);
                if (series.difference > 0 && difference > 0) {
                    series.ratios = std::min(series.ratios + 1, ratios_of_mean);
                    series.log_ratio +=
                        (std::log(difference / series.difference) - series.log_ratio) / series.ratios;
                }
                const double ratio =
                    series.ratios > 0 ? std::min(std::exp(series.log_ratio), slowest_ratio) : 0;
                if (ratio > slow_ratio)
                    halves.error(half)[c] =
                        std::max(halves.error(half)[c], caution_of_series * difference * ratio / (1 - ratio));
                series.difference = difference;
                halves.series(half, c) = series;
            }
        }
        std::size_t next = regions_.count();
        regions_.resize(next + parents.size());
        for (std::size_t p = 0; p < parents.size(); ++p, ++next) {
            regions_.copy(parents[p], halves, 2 * p);
            regions_.copy(next, halves, 2 * p + 1);
        }
        verification_.follow(regions_, parents, regions_.count() - parents.size());
    }

    void add_up() { totals_.add_up(regions_, verification_, confirmation_, evaluations_); }

    void add_warnings(Tally& tally) const {
        std::size_t unseen = 0;
        for (char c : nonzero_) unseen += c == 0;
        if (unseen > 0) {
            std::string what =
                m_ == 1 ? "the integrand was"
                        : std::to_string(unseen) + (unseen == 1 ? " component was" : " components were");
            tally.warnings.push_back(what + " zero at each of " + std::to_string(evaluations_) +
                                     " points; a part where it is not may have been missed");
        }
        if (regions_.count() >= max_regions_)
            tally.warnings.push_back("the memory for regions is used up at " + std::to_string(max_regions_) +
                                     " regions; raise max_memory, or take a method that samples");
        if (!verification_.warning().empty()) tally.warnings.push_back(verification_.warning());
        if ((n_ > 1 || verification_.blind()) && verification_.points() > 0 && !tally.localised) {
            std::ostringstream text;
            text << verification_.points() << " random points checked the rules; they miss other values in 1/"
                 << std::lround(static_cast<double>(verification_.points()) / often_missed)
                 << " of the domain in 5 % of cases";
            tally.notes.push_back(text.str());
        }
        if (totals_.equal_values() && evaluations_ >= most_equal_values)
            tally.warnings.push_back("the integrand was the same at each of " + std::to_string(evaluations_) +
                                     " points; the error is a bound on what they missed");
        for (std::size_t c = 0; c < components(); ++c) {
            if (totals_.inflation(c) < 4 * CubatureTotals::caution(regions_.count())) continue;
            std::ostringstream text;
            text.precision(2);
            text << "the errors of recently halved regions were " << totals_.inflation(c)
                 << " times too small, and were enlarged by that factor; the integrand is rougher than the "
                    "rules assume";
            tally.warnings.push_back(text.str());
            break;
        }
    }

    Problem problem_;
    int n_, m_;
    std::optional<SymmetricRule> coarse_, fine_;
    CubatureRegions regions_;
    std::size_t max_regions_;
    CubatureTotals totals_;
    std::uint64_t evaluations_ = 0;
    ValueBuffer nested_;   // in one dimension: those of the cube, as long as it is the only region
    bool refined_ = false; // the cube was evaluated again by the fine rule
    NonFiniteCount non_finite_;
    std::vector<char> nonzero_;  // a component: was it ever seen to be other than zero?
    bool at_limit_ = false;      // every region's error is rounding
    std::uint64_t singular_ = 0; // evaluations repeated beside singularities
    CubatureVerification verification_;
    std::uint64_t check_points_;
    CubatureConfirmation confirmation_;
};

std::uint64_t default_check_points(int dimensions) { return dimensions == 1 ? 128 : 4096; }

} // namespace

std::unique_ptr<Estimator> Cubature::estimator(const Problem& problem) const {
    if (problem.evaluator.dimensions() > max_dimensions)
        throw Error("cubature", "takes at most " + std::to_string(max_dimensions) +
                                    " variables, since a region costs 2^n evaluations; the domain has " +
                                    std::to_string(problem.evaluator.dimensions()) +
                                    ". Take a method that samples");
    return std::make_unique<CubatureEstimator>(
        problem, max_memory, check_points.value_or(default_check_points(problem.evaluator.dimensions())));
}

} // namespace montelux
