#include "montelux/mc/integrate/integrate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint64_t default_evaluations = 1'000'000;
constexpr std::uint64_t no_limit = ~std::uint64_t{0};

void check_error(const char* what, double error) {
    if (error >= 0 && std::isfinite(error)) return;
    std::ostringstream text;
    text << "the " << what << " error asked for is " << error
         << "; expected a finite number that is not negative";
    throw Error("integrate", text.str());
}

// One run: the estimator and what drives it.
class Run {
  public:
    Run(const Integrand& f, const Domain& domain, const Method& method, const Budget& budget,
        const IntegrationOptions& options)
        : evaluator_(f, domain, options.non_finite), budget_(budget), options_(options),
          method_(method.name()), targeted_(budget.relative_error > 0 || budget.absolute_error > 0) {
        check_error("relative", budget.relative_error);
        check_error("absolute", budget.absolute_error);
        if (!(budget.time.count() >= 0)) throw Error("integrate", "expected a time that is not negative");
        if (options.threads < 0)
            throw Error("integrate", "expected a number of threads that is not negative");
        if (options.resume && options.checkpoint.empty())
            throw Error("integrate", "resume was asked for without a checkpoint file to resume from");
        limit_ = budget.evaluations > 0                 ? budget.evaluations
                 : targeted_ || budget.time.count() > 0 ? no_limit
                                                        : default_evaluations;
        estimator_ = method.estimator({evaluator_, options.seed, options.full_covariance});
    }

    IntegrationResult operator()() {
        if (options_.resume && std::filesystem::exists(options_.checkpoint)) restore();
        Clock::time_point saved = Clock::now();
        StopReason stop;
        for (;;) {
            const Tally tally = estimator_->tally();
            // The first evaluations are always made: nothing is known without them.
            if (tally.evaluations > 0) {
                if (targeted_ && tally.ready && reached(tally)) {
                    stop = StopReason::error_target;
                    break;
                }
                if (tally.evaluations >= limit_) {
                    stop = StopReason::evaluations;
                    break;
                }
                if (budget_.time.count() > 0 && elapsed() >= budget_.time.count()) {
                    stop = StopReason::time;
                    break;
                }
            }
            if (options_.cancel && options_.cancel->requested()) {
                stop = StopReason::cancelled;
                break;
            }
            const StepOutcome outcome = estimator_->step({limit_ - tally.evaluations, budget_.relative_error,
                                                          budget_.absolute_error, options_.cancel});
            if (outcome != StepOutcome::advanced) {
                stop = outcome == StepOutcome::cancelled  ? StopReason::cancelled
                       : outcome == StepOutcome::finished ? StopReason::finished
                                                          : StopReason::evaluations;
                break;
            }
            record();
            if (options_.progress) options_.progress(result(StopReason::finished));
            if (!options_.checkpoint.empty() && Clock::now() - saved >= options_.checkpoint_every) {
                save();
                saved = Clock::now();
            }
        }
        if (!options_.checkpoint.empty()) save();
        return result(stop);
    }

  private:
    double elapsed() const {
        return seconds_before_ + std::chrono::duration<double>(Clock::now() - start_).count();
    }

    bool reached(const Tally& tally) const {
        for (std::size_t c = 0; c < tally.value.size(); ++c) {
            const double target =
                std::max(budget_.absolute_error, budget_.relative_error * std::abs(tally.value[c]));
            if (!(tally.standard_error[c] <= target)) return false;
        }
        return true;
    }

    void record() {
        const Tally tally = estimator_->tally();
        history_.push_back({tally.evaluations, tally.value.at(0), tally.standard_error.at(0), elapsed()});
        // Memory stays bounded however long a run is: every second of the older records goes.
        constexpr std::size_t most = 4096;
        if (history_.size() < most) return;
        std::size_t kept = 0;
        for (std::size_t i = 1; i < history_.size(); i += 2) history_[kept++] = history_[i];
        history_.resize(kept);
    }

    IntegrationResult result(StopReason stop) const {
        Tally tally = estimator_->tally();
        IntegrationResult r;
        r.value = std::move(tally.value);
        r.standard_error = std::move(tally.standard_error);
        r.covariance = std::move(tally.covariance);
        r.statistical = tally.statistical;
        r.evaluations = tally.evaluations;
        r.non_finite = tally.non_finite.count;
        r.first_non_finite_point = std::move(tally.non_finite.first_point);
        r.history = history_;
        r.chi_squared = tally.chi_squared;
        r.degrees_of_freedom = tally.degrees_of_freedom;
        if (tally.degrees_of_freedom > 0)
            r.p_value = chi_squared_p_value(tally.chi_squared, tally.degrees_of_freedom);
        r.method = tally.method.empty() ? method_ : tally.method;
        r.reason = std::move(tally.reason);
        r.stop = stop;
        r.doubts = std::move(tally.doubts);
        if (r.non_finite > 0) {
            std::ostringstream text;
            text.precision(17);
            text << r.non_finite << " of " << r.evaluations
                 << " values of the integrand were not finite and were left out, the first at (";
            for (std::size_t d = 0; d < r.first_non_finite_point.size(); ++d)
                text << (d ? ", " : "") << r.first_non_finite_point[d];
            text << ")";
            r.doubts.push_back(text.str());
        }
        r.seconds = elapsed();
        return r;
    }

    // A state belongs to a problem and a method; the integrand itself cannot be told apart, so its values at
    // a few points stand for it.
    std::uint64_t fingerprint() const {
        std::uint64_t key = hash_key(options_.seed, evaluator_.dimensions(), evaluator_.components(),
                                     options_.full_covariance);
        for (char c : method_ + evaluator_.domain().description())
            key = hash_key(key, static_cast<std::uint64_t>(c));
        PointBuffer u(4, evaluator_.dimensions());
        for (std::size_t i = 0; i < u.count(); ++i)
            for (int d = 0; d < u.dimensions(); ++d)
                u(i, d) = 0.1 + 0.2 * static_cast<double>(i) + 0.05 * (d % 3);
        ValueBuffer g(u.count(), evaluator_.components());
        NonFiniteCount ignored;
        Evaluator lenient(evaluator_.integrand(), evaluator_.domain());
        lenient(u, g, ignored);
        for (int c = 0; c < g.components(); ++c)
            for (double v : std::as_const(g).component(c))
                key = hash_key(key, std::bit_cast<std::uint64_t>(v));
        return key;
    }

    void save() const {
        StateWriter state;
        state.put(fingerprint());
        state.put(elapsed());
        state.put(static_cast<std::uint64_t>(history_.size()));
        for (const IterationRecord& h : history_) {
            state.put(h.evaluations);
            state.put(h.value);
            state.put(h.standard_error);
            state.put(h.seconds);
        }
        estimator_->save(state);
        write_state(options_.checkpoint, "integration", state);
    }

    void restore() {
        StateReader state = read_state(options_.checkpoint, "integration");
        if (state.get_word() != fingerprint())
            throw Error(options_.checkpoint, "belongs to another integrand, domain, method or seed");
        seconds_before_ = state.get_double();
        history_.resize(std::min<std::uint64_t>(state.get_word(), 1 << 16));
        for (IterationRecord& h : history_) {
            h.evaluations = state.get_word();
            h.value = state.get_double();
            h.standard_error = state.get_double();
            h.seconds = state.get_double();
        }
        try {
            estimator_->load(state);
        } catch (const Error& error) {
            throw Error(options_.checkpoint, error.what());
        }
        if (!state.at_end()) throw Error(options_.checkpoint, "holds more than the method can use");
    }

    Evaluator evaluator_;
    Budget budget_;
    const IntegrationOptions& options_;
    std::string method_;
    bool targeted_;
    std::uint64_t limit_ = 0;
    std::unique_ptr<Estimator> estimator_;
    std::vector<IterationRecord> history_;
    double seconds_before_ = 0; // in earlier parts of a run that was resumed
    Clock::time_point start_ = Clock::now();
};

} // namespace

IntegrationResult integrate(const Integrand& f, const Domain& domain, const Method& method,
                            const Budget& budget, const IntegrationOptions& options) {
    return with_threads(options.threads, [&] { return Run(f, domain, method, budget, options)(); });
}

} // namespace montelux
