#include "montelux/mc/integrate/integrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>
#include <utility>

#include "montelux/mc/integrate/domain_probe.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrand_scale.h"
#include "montelux/mc/integrate/integrate_log.h"
#include "montelux/mc/integrate/integration_request.h"
#include "montelux/mc/integrate/interruptible.h"
#include "montelux/mc/integrate/iteration_history.h"
#include "montelux/mc/integrate/problem_fingerprint.h"
#include "montelux/mc/integrate/tally_checks.h"
#include "montelux/mc/integrate/trained/trained_density.h"
#include "montelux/mc/integrate/witness/evidence.h"
#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint64_t default_evaluations = 1'000'000;
// Layout of checkpoints, to be raised with each change of what a part of a run saves.
constexpr std::uint64_t state_version = 4;
constexpr std::uint64_t no_limit = ~std::uint64_t{0};
constexpr std::uint64_t most_of_look = 2048;  // evaluations,
constexpr std::uint64_t share_of_look = 16;   // and one over the largest share of the limit
constexpr std::uint64_t least_for_look = 512; // smaller limits leave no room for one
// Evaluations after which the largest values are examined, and the factor of them until the next time.
constexpr std::uint64_t first_examination = 8192, next_examination = 8;
// Exponents of values: of spikes, and of those that need no scale.
constexpr double far_scale = 400, near_scale = 200;
constexpr double zero_within = 3; // errors within which a value counts as zero
// Costs assumed until the first step is timed, in seconds: of the first calls of the integrand, and of the method's own
// work per evaluation.
constexpr double first_calls = 1e-4, work_per_evaluation = 3e-7;

// log2 |dx/du| at a point inside the domain; 0 where it is zero or infinite there.
double volume_exponent(const Domain& domain) {
    PointBuffer u(1, domain.uniforms()), x(1, domain.dimensions());
    for (int d = 0; d < u.dimensions(); ++d) u(0, d) = 0.4 + 0.2 / (d + 1);
    std::array<double, 1> volume{1};
    domain.map(u, x, volume);
    const double size = std::abs(domain.constant_volume() != 0 ? domain.constant_volume() : volume[0]);
    return size > 0 && std::isfinite(size) ? std::log2(size) : 0;
}

// One run: the estimator and its control.
class Run {
  public:
    Run(const Integrand& f, IntegrandForm form, const Domain& domain, const Method& method,
        const Budget& budget, const IntegrationOptions& options)
        : interruption_(options.cancel), f_(interruptible(f, interruption_)),
          scale_(f.components(), form, budget.absolute_error > 0, volume_exponent(domain)),
          evaluator_(scaled(f_, scale_), domain, options.non_finite), evidence_(evaluator_, options.seed),
          budget_(budget), options_(options), make_estimator_(method), method_(method.name()),
          targeted_(budget.relative_error > 0 || budget.absolute_error > 0) {
        check_request(budget, options);
        limit_ = budget.evaluations > 0                 ? budget.evaluations
                 : targeted_ || budget.time.count() > 0 ? no_limit
                                                        : default_evaluations;
        by_default_ = targeted_ && budget.evaluations == 0 && !(budget.time.count() > 0);
        if (by_default_) budget_.time = std::chrono::duration<double>(Budget::default_seconds);
        make_estimator();
        start_ = Clock::now(); // a device has compiled the estimator's kernels
    }

    double exponent() const { return scale_.exponent(0); }

    IntegrationResult operator()() {
        if (!options_.checkpoint.empty()) {
            check_generation_writable(options_.checkpoint); // before the work, not after it
            const bool exists = generation_exists(options_.checkpoint);
            if (exists && !options_.resume)
                throw Error(options_.checkpoint,
                            "exists already; resume from it, or remove it to start again");
            fingerprint_ = problem_fingerprint(f_, evaluator_, method_, options_);
            if (exists) restore();
        }
        Clock::time_point saved = Clock::now();
        std::optional<StopReason> stop;
        if (estimator_->tally().evaluations == 0 && evidence_.evaluations() == 0) stop = look();
        while (!stop && !(stop = reason_to_stop())) {
            stop = step();
            if (stop) break;
            if (scale_moved()) {
                start_again();
                continue;
            }
            check_finite();
            examine();
            record();
            if (options_.progress) options_.progress(result(std::nullopt));
            if (!options_.checkpoint.empty() && Clock::now() - saved >= options_.checkpoint_every) {
                save();
                saved = Clock::now();
            }
        }
        if (!options_.checkpoint.empty()) save();
        IntegrationResult r = result(stop);
        if (auto unit = estimator_->density())
            r.density = std::make_shared<const TrainedDensity>(std::move(unit), evaluator_.domain());
        return r;
    }

  private:
    bool has_time() const { return budget_.time.count() > 0; }
    // Evaluations besides those of the estimator.
    std::uint64_t others() const { return lost_ + evidence_.evaluations(); }

    void make_estimator() {
        estimator_ = make_estimator_.estimator(
            {evaluator_, options_.seed, options_.full_covariance, &evidence_.seen()});
    }

    // The first look, repeated until the scale is that of the values that it sees.
    std::optional<StopReason> look() {
        const FirstLookUse use = make_estimator_.first_look();
        if (use == FirstLookUse::never || (use == FirstLookUse::with_target && !targeted_) ||
            limit_ < least_for_look) {
            if (budget_.absolute_error > 0) settle_scale();
            return std::nullopt;
        }
        constexpr int most_looks = 4;
        if (has_time()) interruption_.set_deadline(deadline());
        try {
            for (int i = 0; i < most_looks; ++i) {
                evidence_.look(f_, std::min(most_of_look, limit_ / share_of_look));
                const std::vector<double> units = scale_.exponents();
                const bool moved = scale_.adjust();
                if (i == 0 && scale_.form() == IntegrandForm::value && follows_spikes(units)) {
                    scale_.ignore_spikes();
                    evidence_.look(f_, std::min(most_of_look, limit_ / share_of_look));
                    scale_.ignore_spikes();
                    break;
                }
                if (!moved) break;
            }
            const FirstLook& seen = evidence_.seen();
            if (seen.evaluations > 0)
                rate_ = 1 / (work_per_evaluation + std::max(0.0, seen.seconds - first_calls) /
                                                       static_cast<double>(seen.evaluations));
            const std::vector<double> largest = scale_.largest();
            evidence_.weigh_rounding(f_, has_time() ? budget_.time.count() * rate_ : infinity);
            scale_.restore_largest(largest);
        } catch (const IntegrandInterrupted&) {
            interruption_.clear_deadline();
            return interruption_.cancelled() ? StopReason::interrupted : StopReason::time;
        }
        interruption_.clear_deadline();
        make_estimator();
        return std::nullopt;
    }

    // Is the scale that of single huge values (at points where a pole is rounded to infinity, nearly), although most
    // values need none?
    bool follows_spikes(const std::vector<double>& units) const {
        for (std::size_t c = 0; c < static_cast<std::size_t>(evaluator_.components()); ++c) {
            if (!(scale_.exponent(c) > far_scale)) continue;
            std::vector<double> sizes;
            for (const Witness& w : evidence_.seen().witnesses)
                if (w.value[c] != 0) sizes.push_back(std::log2(std::abs(w.value[c])) + units[c]);
            if (sizes.empty()) continue;
            const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
            std::ranges::nth_element(sizes, middle);
            if (std::abs(*middle) < near_scale) return true;
        }
        return false;
    }

    // An absolute error is scaled like the values before the first of them is judged by it.
    void settle_scale() {
        const DomainProbe probe(evaluator_.domain());
        ValueBuffer ignored(probe.x.count(), evaluator_.components());
        evaluator_.integrand()(probe.x, ignored);
        lost_ += probe.x.count();
    }

    // Moves the scale, and with it the evidence, if sums may overflow or underflow.
    bool scale_moved() {
        std::vector<double> units = scale_.exponents();
        if (!scale_.adjust()) return false;
        for (std::size_t c = 0; c < units.size(); ++c) units[c] -= scale_.exponent(c);
        evidence_.rescale(units);
        return true;
    }

    // Starts again after a change of scale: sums so far overflowed or underflowed.
    void start_again() {
        lost_ += estimator_->tally().evaluations;
        history_ = {};
        make_estimator();
    }

    // Looks at the largest values before a claim, and now and then.
    void examine() {
        const Tally tally = estimator_->tally();
        const bool claims = targeted_ && tally.ready && reached(tally);
        if (tally.evaluations == 0 || (!claims && tally.evaluations < next_examination_)) return;
        if (make_estimator_.first_look() == FirstLookUse::never) return;
        next_examination_ = std::max(next_examination_, next_examination * tally.evaluations);
        const std::vector<double> largest = scale_.largest();
        try {
            const std::uint64_t used = tally.evaluations + others();
            evidence_.examine(tally, limit_ > used ? limit_ - used : 0);
        } catch (const IntegrandInterrupted&) { // the run ends
        }
        scale_.restore_largest(largest);
    }

    std::optional<StopReason> reason_to_stop() const {
        const Tally tally = estimator_->tally();
        // Nothing is known without evaluations.
        if (tally.evaluations > 0) {
            if (!evidence_.divergence().empty()) return StopReason::diverges;
            if (targeted_ && tally.ready && reached(tally))
                return nothing_found(tally) || !reached(judged(tally)) ? StopReason::finished
                                                                       : StopReason::error_target;
            if (targeted_ && tally.ready && is_rounding(tally)) return StopReason::finished;
            if (tally.evaluations + others() >= limit_ ||
                (by_default_ && tally.evaluations + others() >= Budget::default_most_evaluations))
                return StopReason::evaluations;
            if (has_time() && elapsed() >= budget_.time.count()) return StopReason::time;
        }
        if (interruption_.cancelled()) return StopReason::interrupted;
        return std::nullopt;
    }

    // One step of the estimator; the reason to stop where it did not advance.
    std::optional<StopReason> step() {
        const Tally tally = estimator_->tally();
        const std::uint64_t done = tally.evaluations, used = done + others();
        sizes_ = sizes(tally);
        StepRequest request = target();
        request.max_evaluations = limit_ > used ? limit_ - used : 0;
        if (!has_time()) return outcome_of(attempt(request), false);

        // Methods plan for the evaluations that fit into the time, with the speed so far; by default only at the end,
        // so that the time makes no difference before.
        const double remaining = budget_.time.count() - elapsed();
        const std::uint64_t most = request.max_evaluations;
        const double fits = std::max(1.0, 0.95 * rate_ * std::max(remaining, 0.0));
        const bool plans = !by_default_ || fits < static_cast<double>(done);
        const bool shortened = plans && rate_ > 0 && fits < static_cast<double>(most);
        if (shortened) request.max_evaluations = static_cast<std::uint64_t>(fits);
        if (done > 0) return timed(request, deadline(), shortened);
        // The first step's duration is unknown. If half of the time is not enough for it, the evaluations
        // made so far say how many fit into the other half, on one thread at least.
        if (remaining <= 0) return StopReason::time;
        const std::uint64_t before = interruption_.evaluations();
        const auto half = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                             std::chrono::duration<double>(0.5 * remaining));
        std::optional<StopReason> stop = timed(request, half, shortened);
        if (stop == StopReason::time && shortened && interruption_.evaluations() == before) {
            // The first step takes more than the plan allows: tried all the same.
            request.max_evaluations = most;
            stop = timed(request, half, false);
        }
        if (stop != StopReason::time) return stop;
        const std::uint64_t made = interruption_.evaluations() - before;
        if (made >= request.max_evaluations) return stop;
        lost_ += made;
        const double fit = 0.8 * static_cast<double>(made) / thread_count();
        request.max_evaluations = std::min(request.max_evaluations - made, static_cast<std::uint64_t>(fit));
        if (request.max_evaluations == 0) return stop;
        return timed(request, deadline(), true);
    }

    // A step that is interrupted at a point in time. `shortened`: more evaluations were allowed than time.
    std::optional<StopReason> timed(StepRequest request, Clock::time_point until, bool shortened) {
        const std::uint64_t before = estimator_->tally().evaluations;
        const Clock::time_point begin = Clock::now();
        interruption_.set_deadline(until);
        request.deadline = until;
        const StepOutcome outcome = attempt(request);
        interruption_.clear_deadline();
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        if (outcome == StepOutcome::advanced && seconds > 0)
            rate_ = static_cast<double>(estimator_->tally().evaluations - before) / seconds;
        if (outcome == StepOutcome::cancelled && !interruption_.cancelled()) return StopReason::time;
        return outcome_of(outcome, shortened);
    }

    std::optional<StopReason> outcome_of(StepOutcome outcome, bool shortened) const {
        switch (outcome) {
        case StepOutcome::advanced:
            return std::nullopt;
        case StepOutcome::cancelled:
            return StopReason::interrupted;
        case StepOutcome::finished:
            return StopReason::finished;
        case StepOutcome::exhausted:
            break;
        }
        if (shortened) return StopReason::time;
        if (estimator_->tally().evaluations == 0 && lost_ == 0)
            throw Error("integrate", "the method '" + method_ + "' takes more than " +
                                         std::to_string(limit_) + " evaluations for its first step in " +
                                         std::to_string(evaluator_.dimensions()) +
                                         " dimensions; expected a larger limit");
        return StopReason::evaluations;
    }

    StepOutcome attempt(const StepRequest& request) {
        try {
            return estimator_->step(request);
        } catch (const IntegrandInterrupted&) {
            return StepOutcome::cancelled;
        }
    }

    Clock::time_point deadline() const {
        // Times beyond a hundred years do not fit into the clock.
        const double seconds = std::min(budget_.time.count() - seconds_before_, 3.2e9);
        return start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }

    // Zeros that replace NaN must not pass for a result.
    void check_finite() const {
        const Tally tally = estimator_->tally();
        if (tally.evaluations == 0 || tally.non_finite.count < tally.evaluations) return;
        throw Error("integrate", "none of the " + std::to_string(tally.evaluations) +
                                     " values of the integrand is a finite number; the first point was " +
                                     point_text(tally.non_finite.first_point));
    }

    double elapsed() const {
        return seconds_before_ + std::chrono::duration<double>(Clock::now() - start_).count();
    }

    bool reached(const Tally& tally) const {
        if (nothing_found(tally) && tally.evaluations < default_evaluations) return false;
        const std::vector<double> own = sizes(tally);
        StepRequest request = target();
        request.sizes = own;
        return meets(tally, request);
    }

    StepRequest target() const {
        StepRequest request;
        request.relative_error = budget_.relative_error;
        request.absolute_error = budget_.absolute_error > 0 ? scale_.scaled(budget_.absolute_error) : 0;
        request.cancel = options_.cancel;
        request.sizes = sizes_;
        return request;
    }

    // What a relative error refers to besides the values: their norm; or, of values of both signs that are zero within
    // their errors, the integrals of the absolute values. Where a method does not know these, its error as of independent samples
    // tells a size that they exceed.
    std::vector<double> sizes(const Tally& tally) const {
        std::vector<double> all(tally.value.size(), 0.0);
        if (!(budget_.relative_error > 0) || tally.evaluations == 0) return {};
        if (budget_.norm == ErrorNorm::vector) {
            double squares = 0;
            for (double v : tally.value) squares += v * v;
            std::ranges::fill(all, std::sqrt(squares));
            return all;
        }
        for (std::size_t c = 0; c < all.size(); ++c) {
            const double error = tally.standard_error[c];
            if (!std::isfinite(error) || std::abs(tally.value[c]) > zero_within * error ||
                !evidence_.cancels(c))
                continue;
            all[c] = !tally.absolute.empty() ? tally.absolute[c]
                     : tally.statistical     ? error * std::sqrt(static_cast<double>(tally.evaluations))
                                             : 0;
        }
        return all;
    }

    // A tally beside the evidence of the run.
    Tally judged(Tally tally) const {
        if (make_estimator_.first_look() == FirstLookUse::never || tally.evaluations == 0) return tally;
        const std::vector<double> own = sizes(tally);
        StepRequest request = target();
        request.sizes = own;
        const std::shared_ptr<const UnitDensity> density = estimator_->sampled_density();
        evidence_.judge(density.get(), request, tally);
        return tally;
    }

    // In the unit of f; of logarithms, relative to 2^exponent().
    double in_unit(double x, std::size_t component) const {
        return scale_.form() == IntegrandForm::logarithm ? x : scale_.unscaled(x, component);
    }

    void record() {
        const Tally tally = estimator_->tally();
        if (tally.value.empty()) return;
        history_.add({tally.evaluations + others(), in_unit(tally.value.at(0), 0),
                      in_unit(tally.standard_error.at(0), 0), elapsed()});
    }

    IntegrationResult result(std::optional<StopReason> ended) const {
        const StopReason stop = ended.value_or(StopReason::finished);
        Tally tally = ended ? judged(estimator_->tally()) : estimator_->tally();
        const bool unchecked = targeted_ && !tally.statistical && !tally.ready && tally.warnings.empty();
        const Tally before = estimator_->tally(); // it was judged
        const bool only_zeros = nothing_found(before);
        const bool rounding = (tally.at_limit && tally.warnings.empty()) || is_rounding(tally);
        const std::vector<double> values = tally.value, errors = tally.standard_error; // scaled
        IntegrationResult r;
        r.value = std::move(tally.value);
        r.standard_error = std::move(tally.standard_error);
        r.covariance = std::move(tally.covariance);
        for (std::size_t c = 0; c < r.value.size(); ++c) {
            r.value[c] = in_unit(r.value[c], c);
            r.standard_error[c] = in_unit(r.standard_error[c], c);
        }
        for (std::size_t i = 0; i < r.covariance.size(); ++i)
            if (scale_.form() == IntegrandForm::value)
                r.covariance[i] =
                    scale_.unscaled_product(r.covariance[i], i / r.value.size(), i % r.value.size());
        r.statistical = tally.statistical;
        r.evaluations = tally.evaluations + others();
        r.non_finite = tally.non_finite.count;
        r.first_non_finite_point = std::move(tally.non_finite.first_point);
        r.history = history_.records();
        r.chi_squared = tally.chi_squared;
        r.degrees_of_freedom = tally.degrees_of_freedom;
        if (tally.degrees_of_freedom > 0)
            r.p_value = std::isnan(tally.p_value)
                            ? chi_squared_p_value(tally.chi_squared, tally.degrees_of_freedom)
                            : tally.p_value;
        r.method = tally.method.empty() ? method_ : tally.method;
        r.reason = std::move(tally.reason);
        r.stop = stop;
        r.warnings = std::move(tally.warnings);
        r.notes = std::move(tally.notes);
        add_notes(values, errors, r);
        if (only_zeros) {
            if (r.warnings.empty())
                r.warnings.push_back("a value was zero at every point; a narrow peak may have been missed");
            // Zeros give no scale for what was missed.
            const std::size_t m = r.value.size();
            for (std::size_t c = 0; c < m; ++c) {
                if (before.value[c] != 0 || before.standard_error[c] != 0) continue;
                r.standard_error[c] = std::numeric_limits<double>::infinity();
                if (!r.covariance.empty()) r.covariance[c * m + c] = r.standard_error[c];
            }
        }
        if (targeted_ && stop == StopReason::finished && rounding)
            r.warnings.push_back("the error asked for is below the rounding error of double precision");
        if (unchecked && stop != StopReason::error_target)
            r.warnings.push_back("random points had not confirmed the rules when the run ended");
        if (tally.localised)
            r.warnings.push_back(
                "the integrand is concentrated in a part of the domain that is too small for a check by "
                "random points; other such parts may have been missed");
        if (r.non_finite > 0)
            r.warnings.push_back(std::to_string(r.non_finite) + " of " + std::to_string(r.evaluations) +
                                 " values of the integrand were not finite and were left out, the first at " +
                                 point_text(r.first_non_finite_point));
        if (tally.non_finite.vanished > 0)
            r.notes.push_back(
                "values far out, where the integrand has vanished, are no numbers and count as zero (" +
                std::to_string(tally.non_finite.vanished) + " of " + std::to_string(r.evaluations) + ")");
        if (stop == StopReason::diverges) {
            r.warnings = {"the integral diverges, or converges too slowly to tell: " +
                          evidence_.divergence()};
            std::ranges::fill(r.standard_error, std::numeric_limits<double>::infinity());
            std::ranges::fill(r.covariance, std::numeric_limits<double>::infinity());
        }
        if (std::ranges::any_of(r.value, [](double v) { return std::isinf(v); }))
            r.warnings.push_back("a value is beyond the range of double precision; integrate the logarithm");
        r.checkpoint_refused_because = checkpoint_refused_because_;
        r.seconds = elapsed();
        return r;
    }

    void add_notes(const std::vector<double>& values, const std::vector<double>& errors,
                   IntegrationResult& r) const {
        if (by_default_ && (r.stop == StopReason::time || r.stop == StopReason::evaluations)) {
            std::ostringstream text;
            text << "stopped at the default limit of "
                 << (r.stop == StopReason::time ? Budget::default_seconds
                                                : double(Budget::default_most_evaluations))
                 << (r.stop == StopReason::time ? " s" : " evaluations")
                 << "; give a time or evaluations for another";
            r.notes.push_back(text.str());
        }
        if (r.stop != StopReason::error_target || budget_.norm == ErrorNorm::vector) return;
        StepRequest alone = target();
        alone.sizes = {};
        for (std::size_t c = 0; c < r.value.size(); ++c)
            if (errors[c] > alone.tolerance(c, values[c]))
                r.notes.push_back(
                    (r.value.size() > 1 ? "component " + std::to_string(c + 1) : "the value") +
                    " is zero within its error, whose target was measured against the integral of |f|");
    }

    void save() const {
        StateWriter state;
        state.put(state_version);
        state.put(fingerprint_);
        state.put(elapsed());
        state.put(lost_);
        state.put(next_examination_);
        scale_.save(state);
        evidence_.save(state);
        history_.save(state);
        estimator_->save(state);
        write_state(options_.checkpoint, "integration", state);
    }

    void restore() {
        SavedState saved = read_state(options_.checkpoint, "integration");
        checkpoint_refused_because_ = std::move(saved.newest_refused_because);
        StateReader& state = saved.reader;
        if (state.get_word() != state_version)
            throw Error(options_.checkpoint,
                        "was saved by another version of Montelux; remove it to start again");
        if (state.get_word() != fingerprint_)
            throw Error(options_.checkpoint, "belongs to another integrand, domain, method or seed");
        seconds_before_ = state.get_double();
        lost_ = state.get_word();
        next_examination_ = state.get_word();
        scale_.load(state);
        evidence_.load(state);
        make_estimator();
        history_.load(state);
        try {
            estimator_->load(state);
        } catch (const Error& error) {
            throw Error(options_.checkpoint, error.what());
        }
        if (!state.at_end()) throw Error(options_.checkpoint, "holds more than the method can use");
    }

    Interruption interruption_;
    Integrand f_;
    IntegrandScale scale_;
    Evaluator evaluator_;
    Evidence evidence_;
    Budget budget_;
    const IntegrationOptions& options_;
    Method make_estimator_;
    std::string method_;
    bool targeted_;
    std::uint64_t limit_ = 0;
    bool by_default_ = false;                            // the limits are the default ones
    std::vector<double> sizes_;                          // of the request of the last step
    std::uint64_t lost_ = 0;                             // evaluations of discarded steps (time or scale)
    std::uint64_t next_examination_ = first_examination; // evaluations of the estimator
    double rate_ = 0;                                    // evaluations per second in the last step
    std::uint64_t fingerprint_ = 0;
    std::string checkpoint_refused_because_;
    std::unique_ptr<Estimator> estimator_;
    IterationHistory history_;
    double seconds_before_ = 0; // in earlier parts of a run that was resumed
    Clock::time_point start_;
};

} // namespace

IntegrationResult integrate(const Integrand& f, const Domain& domain, const Method& method,
                            const Budget& budget, const IntegrationOptions& options) {
    return with_threads(options.threads,
                        [&] { return Run(f, IntegrandForm::value, domain, method, budget, options)(); });
}

LogIntegrationResult integrate_log(const Integrand& log_f, const Domain& domain, const Method& method,
                                   const Budget& budget, const IntegrationOptions& options) {
    if (log_f.components() != 1)
        throw Error("integrate_log", "expected one component, got " + std::to_string(log_f.components()));
    if (budget.absolute_error > 0)
        throw Error("integrate_log", "an absolute error of Z was asked for; expected a relative error, which "
                                     "is the absolute error of log Z");
    return with_threads(options.threads, [&] {
        Run run(log_f, IntegrandForm::logarithm, domain, method, budget, options);
        LogIntegrationResult result;
        result.relative = run();
        result.log_reference = run.exponent() * std::numbers::ln2;
        const double value = result.relative.value[0], error = result.relative.standard_error[0];
        result.log_value =
            value > 0 ? std::log(value) + result.log_reference : -std::numeric_limits<double>::infinity();
        result.log_error = value > 0 ? error / value : std::numeric_limits<double>::infinity();
        return result;
    });
}

} // namespace montelux
