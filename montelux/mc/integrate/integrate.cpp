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

#include "montelux/mc/integrate/integrand_scale.h"
#include "montelux/mc/integrate/integrate_log.h"
#include "montelux/mc/integrate/integration_request.h"
#include "montelux/mc/integrate/interruptible.h"
#include "montelux/mc/integrate/iteration_history.h"
#include "montelux/mc/integrate/problem_fingerprint.h"
#include "montelux/mc/integrate/tally_checks.h"
#include "montelux/mc/integrate/trained/trained_density.h"
#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"

namespace montelux {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint64_t default_evaluations = 1'000'000;
constexpr std::uint64_t no_limit = ~std::uint64_t{0};

std::string point_text(const std::vector<double>& point) {
    std::ostringstream text;
    text.precision(17);
    text << "(";
    constexpr std::size_t most = 8;
    for (std::size_t d = 0; d < std::min(most, point.size()); ++d) text << (d ? ", " : "") << point[d];
    text << (point.size() > most ? ", ...)" : ")");
    return text.str();
}

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
          evaluator_(scaled(f_, scale_), domain, options.non_finite), budget_(budget), options_(options),
          make_estimator_(method), method_(method.name()),
          targeted_(budget.relative_error > 0 || budget.absolute_error > 0) {
        check_request(budget, options);
        limit_ = budget.evaluations > 0    ? budget.evaluations
                 : targeted_ || has_time() ? no_limit
                                           : default_evaluations;
        make_estimator();
        start_ = Clock::now(); // a device has compiled the estimator's kernels
    }

    double exponent() const { return scale_.exponent(0); }

    IntegrationResult operator()() {
        if (!options_.checkpoint.empty()) {
            check_generation_writable(options_.checkpoint); // before the work, not after it
            fingerprint_ = problem_fingerprint(f_, evaluator_, method_, options_);
            if (options_.resume && generation_exists(options_.checkpoint)) restore();
        }
        Clock::time_point saved = Clock::now();
        std::optional<StopReason> stop;
        while (!(stop = reason_to_stop())) {
            stop = step();
            if (stop) break;
            if (scale_.adjust()) {
                start_again();
                continue;
            }
            check_finite();
            record();
            if (options_.progress) options_.progress(result(StopReason::finished));
            if (!options_.checkpoint.empty() && Clock::now() - saved >= options_.checkpoint_every) {
                save();
                saved = Clock::now();
            }
        }
        if (!options_.checkpoint.empty()) save();
        IntegrationResult r = result(*stop);
        if (auto unit = estimator_->density())
            r.density = std::make_shared<const TrainedDensity>(std::move(unit), evaluator_.domain());
        return r;
    }

  private:
    bool has_time() const { return budget_.time.count() > 0; }

    void make_estimator() {
        estimator_ = make_estimator_.estimator({evaluator_, options_.seed, options_.full_covariance});
        absolute_error_ = budget_.absolute_error > 0 ? scale_.scaled(budget_.absolute_error) : 0;
    }

    // Starts again after a change of scale: sums so far overflowed or underflowed.
    void start_again() {
        const std::uint64_t made = estimator_->tally().evaluations;
        lost_ += made;
        // Too few evaluations left would give no result.
        if (limit_ != no_limit && limit_ < lost_ + made) {
            limit_ += made;
            granted_ += made;
        }
        history_ = {};
        make_estimator();
    }

    std::optional<StopReason> reason_to_stop() const {
        const Tally tally = estimator_->tally();
        // Nothing is known without evaluations.
        if (tally.evaluations > 0) {
            if (targeted_ && tally.ready && reached(tally))
                return nothing_found(tally) ? StopReason::finished : StopReason::error_target;
            if (targeted_ && tally.ready && is_rounding(tally)) return StopReason::finished;
            if (tally.evaluations + lost_ >= limit_) return StopReason::evaluations;
            if (has_time() && elapsed() >= budget_.time.count()) return StopReason::time;
        }
        if (interruption_.cancelled()) return StopReason::cancelled;
        return std::nullopt;
    }

    // One step of the estimator; the reason to stop where it did not advance.
    std::optional<StopReason> step() {
        const std::uint64_t done = estimator_->tally().evaluations;
        StepRequest request{limit_ - done - lost_, budget_.relative_error, absolute_error_, options_.cancel};
        if (!has_time()) return outcome_of(attempt(request), false);

        const double remaining = budget_.time.count() - elapsed();
        if (done > 0) {
            // The last step must fit into the remaining time, or it is lost.
            const double fits = std::max(1.0, 0.95 * rate_ * std::max(remaining, 0.0));
            const bool shortened = rate_ > 0 && fits < static_cast<double>(request.max_evaluations);
            if (shortened) request.max_evaluations = static_cast<std::uint64_t>(fits);
            return timed(request, deadline(), shortened);
        }
        // The first step's duration is unknown. If half of the time is not enough for it, the evaluations
        // made so far say how many fit into the other half, on one thread at least.
        if (remaining <= 0) return StopReason::time;
        const std::uint64_t before = interruption_.evaluations();
        const auto half = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                             std::chrono::duration<double>(0.5 * remaining));
        std::optional<StopReason> stop = timed(request, half, false);
        if (stop != StopReason::time) return stop;
        const std::uint64_t made = interruption_.evaluations() - before;
        if (made >= request.max_evaluations) return stop;
        lost_ += made;
        const double fits = 0.8 * static_cast<double>(made) / thread_count();
        request.max_evaluations = std::min(request.max_evaluations - made, static_cast<std::uint64_t>(fits));
        if (request.max_evaluations == 0) return stop;
        return timed(request, deadline(), true);
    }

    // A step that is interrupted at a point in time. `shortened`: more evaluations were allowed than time.
    std::optional<StopReason> timed(const StepRequest& request, Clock::time_point until, bool shortened) {
        const std::uint64_t before = estimator_->tally().evaluations;
        const Clock::time_point begin = Clock::now();
        interruption_.set_deadline(until);
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
            return StopReason::cancelled;
        case StepOutcome::finished:
            return StopReason::finished;
        case StepOutcome::exhausted:
            break;
        }
        if (shortened) return StopReason::time;
        if (estimator_->tally().evaluations == 0)
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
        return meets(tally, budget_.relative_error, absolute_error_);
    }

    // In the unit of f; of logarithms, relative to 2^exponent().
    double in_unit(double x, std::size_t component) const {
        return scale_.form() == IntegrandForm::logarithm ? x : scale_.unscaled(x, component);
    }

    void record() {
        const Tally tally = estimator_->tally();
        if (tally.value.empty()) return;
        history_.add({tally.evaluations + lost_, in_unit(tally.value.at(0), 0),
                      in_unit(tally.standard_error.at(0), 0), elapsed()});
    }

    IntegrationResult result(StopReason stop) const {
        Tally tally = estimator_->tally();
        const bool unchecked = targeted_ && !tally.statistical && !tally.ready && tally.warnings.empty();
        const bool only_zeros = nothing_found(tally);
        const bool rounding = (tally.at_limit && tally.warnings.empty()) || is_rounding(tally);
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
        r.evaluations = tally.evaluations + lost_;
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
        if (only_zeros) {
            if (r.warnings.empty())
                r.warnings.push_back("a value was zero at every point; a narrow peak may have been missed");
            // Zeros give no scale for what was missed.
            const std::size_t m = r.value.size();
            for (std::size_t c = 0; c < m; ++c) {
                if (r.value[c] != 0 || r.standard_error[c] != 0) continue;
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
        r.checkpoint_refused_because = checkpoint_refused_because_;
        r.seconds = elapsed();
        return r;
    }

    void save() const {
        StateWriter state;
        state.put(fingerprint_);
        state.put(elapsed());
        state.put(lost_);
        state.put(granted_);
        scale_.save(state);
        history_.save(state);
        estimator_->save(state);
        write_state(options_.checkpoint, "integration", state);
    }

    void restore() {
        SavedState saved = read_state(options_.checkpoint, "integration");
        checkpoint_refused_because_ = std::move(saved.newest_refused_because);
        StateReader& state = saved.reader;
        if (state.get_word() != fingerprint_)
            throw Error(options_.checkpoint, "belongs to another integrand, domain, method or seed");
        seconds_before_ = state.get_double();
        lost_ = state.get_word();
        granted_ = state.get_word();
        if (limit_ != no_limit) limit_ += granted_;
        scale_.load(state);
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
    Budget budget_;
    double absolute_error_ = 0; // in the unit of the scaled integrand
    const IntegrationOptions& options_;
    Method make_estimator_;
    std::string method_;
    bool targeted_;
    std::uint64_t limit_ = 0;
    std::uint64_t granted_ = 0; // share of the limit for repetitions after a change of scale
    std::uint64_t lost_ = 0;    // evaluations of discarded steps (time or scale)
    double rate_ = 0;           // evaluations per second in the last step
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
