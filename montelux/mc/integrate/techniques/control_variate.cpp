#include "montelux/mc/integrate/techniques/control_variate.h"

#include <cmath>
#include <sstream>
#include <utility>

#include "montelux/mc/integrate/iteration_average.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/techniques/semidefinite.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// f and the controls as one integrand: the components of f first.
Integrand joined(const Integrand& f, const Integrand& controls) {
    const int m = f.components(), k = controls.components();
    return Integrand::batch(
        [f, controls, m, k](const PointBatch& x, ValueBatch y) {
            const auto stride = static_cast<std::size_t>(&y(0, 1) - &y(0, 0));
            f(x, ValueBatch(&y(0, 0), y.count(), m, stride));
            controls(x, ValueBatch(&y(0, m), y.count(), k, stride));
        },
        m + k);
}

// Moments of f with its controls for the regression, and of the residuals for the estimate.
struct ControlSum {
    CovarianceMoments joint;
    SampleMoments residual;

    void merge(const ControlSum& later) {
        joint.merge(later.joint);
        residual.merge(later.residual);
    }
};

class ControlVariateEstimator final : public Estimator {
  public:
    ControlVariateEstimator(const Problem& problem, const ControlVariate& settings)
        : problem_(problem), integrals_(settings.integrals),
          g_(joined(problem.evaluator.integrand(), checked(problem, settings)), problem.evaluator.domain(),
             problem.evaluator.policy()),
          joint_(g_.components()), average_(components(), problem.full_covariance), extremes_(components()) {}

    StepOutcome step(const StepRequest& request) override {
        const std::uint64_t done = joint_.count(), limit = request.max_evaluations;
        // A regression takes more points than unknowns.
        const std::uint64_t least = done == 0 ? static_cast<std::uint64_t>(2 * controls() + 8) : 2;
        std::uint64_t size = next_step_size_after_pilot(done, limit);
        size = std::max(size, least);
        if (size > limit) return StepOutcome::exhausted;
        auto sum = sum_batches(
            size, [&] { return empty(); },
            [&](std::uint64_t first, std::uint64_t count, ControlSum& to) {
                PointBuffer u(count, g_.dimensions());
                ValueBuffer values(count, g_.components());
                fill_random(u, problem_.seed, 0, done + first);
                g_(u, values, to.residual.non_finite);
                add(values, to);
            },
            request.cancel);
        if (!sum) return StepOutcome::cancelled;
        if (!beta_.empty()) {
            auto estimate = IterationEstimate::zero(components(), problem_.full_covariance);
            estimate.add_mean(sum->residual);
            average_.add(static_cast<double>(size), estimate);
            extremes_.merge(sum->residual.extremes);
            averaged_ += size;
        }
        joint_.merge(sum->joint);
        non_finite_.merge(sum->residual.non_finite);
        regress();
        return StepOutcome::advanced;
    }

    Tally tally() const override {
        Tally tally;
        average_.tally(tally);
        warn_of_heavy_tail(extremes_.tail(), averaged_, static_cast<double>(averaged_),
                           tally.standard_error[0], tally.warnings);
        tally.evaluations = joint_.count();
        tally.non_finite = non_finite_;
        warn(tally.warnings);
        return tally;
    }
    void save(StateWriter& state) const override {
        average_.save(state);
        montelux::save(state, joint_);
        montelux::save(state, non_finite_);
        state.put(beta_);
        state.put(averaged_);
        extremes_.save(state);
    }
    void load(StateReader& state) override {
        average_.load(state);
        montelux::load(state, joint_);
        montelux::load(state, non_finite_);
        beta_ = state.get_doubles();
        if (!beta_.empty() && beta_.size() != static_cast<std::size_t>(components()) * integrals_.size())
            throw Error("the saved state has another number of controls");
        averaged_ = state.get_word();
        extremes_.load(state);
    }

  private:
    static const Integrand& checked(const Problem& problem, const ControlVariate& settings) {
        const int k = settings.controls.components();
        if (k < 1 || static_cast<std::size_t>(k) != settings.integrals.size())
            throw Error("control_variate", std::to_string(k) + " controls and " +
                                               std::to_string(settings.integrals.size()) +
                                               " integrals of them; expected as many, and at least one");
        for (double integral : settings.integrals)
            if (!std::isfinite(integral))
                throw Error("control_variate", "expected integrals of the controls that are finite");
        const int fixed = settings.controls.fixed_dimensions();
        if (fixed != 0 && fixed != problem.evaluator.domain().dimensions())
            throw Error("control_variate", "the control takes one number, but the domain has " +
                                               std::to_string(problem.evaluator.domain().dimensions()) +
                                               " dimensions");
        return settings.controls;
    }
    int components() const { return problem_.evaluator.components(); }
    int controls() const { return static_cast<int>(integrals_.size()); }
    ControlSum empty() const {
        return {CovarianceMoments(g_.components()),
                {CovarianceMoments(components(), problem_.full_covariance), {}, extremes_.empty()}};
    }

    void add(const ValueBuffer& values, ControlSum& to) const {
        const int m = components(), k = controls();
        std::vector<double> one(static_cast<std::size_t>(m + k));
        ValueBuffer residuals(values.count(), m);
        for (std::size_t i = 0; i < values.count(); ++i) {
            for (int c = 0; c < m + k; ++c) one[static_cast<std::size_t>(c)] = values(i, c);
            to.joint.add(one);
            if (beta_.empty()) continue;
            for (int c = 0; c < m; ++c) {
                double r = values(i, c);
                for (int j = 0; j < k; ++j)
                    r -= beta(c, j) * (values(i, m + j) - integrals_[static_cast<std::size_t>(j)]);
                residuals.component(c)[i] = r;
            }
        }
        if (!beta_.empty()) to.residual.add(residuals);
    }
    double beta(int component, int control) const {
        return beta_[static_cast<std::size_t>(component) * integrals_.size() +
                     static_cast<std::size_t>(control)];
    }

    void regress() {
        const int m = components(), k = controls();
        std::vector<double> matrix, right;
        for (int a = 0; a < k; ++a)
            for (int b = 0; b < k; ++b) matrix.push_back(joint_.covariance(m + a, m + b));
        for (int c = 0; c < m; ++c)
            for (int a = 0; a < k; ++a) right.push_back(joint_.covariance(c, m + a));
        beta_ = solve_semidefinite(matrix, right, m);
    }

    void warn(std::vector<std::string>& warnings) const {
        constexpr double far = 6; // standard errors
        if (joint_.count() < 1000) return;
        for (int j = 0; j < controls(); ++j) {
            const int c = components() + j;
            const double known = integrals_[static_cast<std::size_t>(j)];
            const double error = std::sqrt(joint_.variance(c) / static_cast<double>(joint_.count()));
            // Rounding, too, keeps a constant control from its integral.
            if (std::abs(joint_.mean(c) - known) <= far * error + 1e-12 * std::abs(known)) continue;
            std::ostringstream text;
            text.precision(6);
            text << "the integral of control " << j + 1 << " was given as " << known
                 << ", but its samples say " << joint_.mean(c) << " +- " << error
                 << ": the value is off by what that is";
            warnings.push_back(text.str());
        }
    }

    Problem problem_;
    std::vector<double> integrals_;
    Evaluator g_; // f and the controls
    CovarianceMoments joint_;
    IterationAverage average_;
    NonFiniteCount non_finite_;
    std::vector<double> beta_;   // component by component; empty before the pilot
    ExtremeValues extremes_;     // of the averaged residuals,
    std::uint64_t averaged_ = 0; // and their number
};

} // namespace

std::unique_ptr<Estimator> ControlVariate::estimator(const Problem& problem) const {
    return std::make_unique<ControlVariateEstimator>(problem, *this);
}

} // namespace montelux
