#include "montelux/mc/integrate/metropolis/metropolis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "montelux/mc/integrate/metropolis/chain_trace.h"
#include "montelux/mc/integrate/metropolis/metropolis_walkers.h"
#include "montelux/mc/integrate/metropolis/student_mixture.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

constexpr int windows = 20;                          // of the burn-in, between which the walk adapts
constexpr std::uint64_t most_pilot_points = 1 << 22; // in search of a start
constexpr std::uint64_t first_step = 1 << 14;
constexpr double converged = 1.01;
constexpr double concentrated = 0.1;
enum Stream : std::uint32_t { pilot_stream = 1, start_stream = 2, normal_stream = 4 };

// Sums of s / q over the points of the importance density.
struct Normalisation {
    RunningMoments moments;
    double largest = 0;
    WalkCounts counts;

    void merge(const Normalisation& later) {
        moments.merge(later.moments);
        largest = std::max(largest, later.largest);
        counts.merge(later.counts);
    }
};

struct State {
    Walkers walkers; // without chains before the pilot has found where s > 0
    StudentMixture density;
    std::uint32_t steps = 0; // number of the next step, of which each has its own random numbers
    std::uint64_t evaluations = 0;
    NonFiniteCount non_finite;
    RunningMoments normalisation;
    double largest = 0;
    std::uint64_t accepted = 0, proposed = 0;
};

class MetropolisEstimator final : public Estimator {
  public:
    MetropolisEstimator(const Problem& problem, const Metropolis& settings)
        : problem_(problem), settings_(settings) {
        const auto expect = [](bool good, const char* what) {
            if (!good) throw Error("Metropolis", what);
        };
        expect(settings.chains >= 2 && settings.chains <= 4096, "expected between 2 and 4096 chains");
        expect(settings.burn_in >= 40 && settings.burn_in <= 1'000'000,
               "expected a burn-in between 40 and a million states");
        expect(settings.pilot >= 16 && settings.pilot <= 1 << 20,
               "expected between 16 and 2^20 pilot points");
        if (problem.evaluator.dimensions() > 256)
            throw Error("Metropolis", "expected at most 256 dimensions, got " +
                                          std::to_string(problem.evaluator.dimensions()));
    }

    StepOutcome step(const StepRequest& request) override {
        if (request.cancel && request.cancel->requested()) return StepOutcome::cancelled;
        const std::uint64_t chains = static_cast<std::uint64_t>(settings_.chains);
        if (state_.walkers.chains.empty()) {
            if (request.max_evaluations < settings_.pilot + chains * settings_.burn_in)
                return StepOutcome::exhausted;
            // No point where s > 0.
            if (state_.evaluations >= most_pilot_points) return StepOutcome::finished;
            return start(request.cancel);
        }
        const double done = static_cast<double>(state_.evaluations);
        std::uint64_t size = next_step_size(static_cast<std::uint64_t>(done), first_step, large_step);
        size = std::min(size, request.max_evaluations);
        // Chains are useless while g / s is constant; an eighth of the evaluations keeps checking.
        const std::uint64_t walked = varied() ? size / 2 : size / 8;
        const std::uint64_t states = walked / chains;
        if (states == 0) return StepOutcome::exhausted;
        State next = state_;
        auto counts = next.walkers.walk(problem_, states, next.steps, 0, nullptr, request.cancel);
        if (!counts) return StepOutcome::cancelled;
        const auto normalisation = normalise(next, size - states * chains, request.cancel);
        if (!normalisation) return StepOutcome::cancelled;
        next.accepted += counts->accepted;
        next.proposed += counts->proposed;
        counts->merge(normalisation->counts);
        take(next, *counts);
        next.normalisation.merge(normalisation->moments);
        next.largest = std::max(next.largest, normalisation->largest);
        ++next.steps;
        state_ = std::move(next);
        return StepOutcome::advanced;
    }

    Tally tally() const override {
        const auto m = static_cast<std::size_t>(problem_.evaluator.components());
        Tally tally;
        tally.evaluations = state_.evaluations;
        tally.non_finite = state_.non_finite;
        tally.value.assign(m, 0);
        tally.standard_error.assign(m, std::numeric_limits<double>::infinity());
        tally.ready = state_.normalisation.count() > 1;
        if (!tally.ready) {
            if (state_.evaluations > 0 && state_.walkers.chains.empty())
                tally.warnings.emplace_back("no point of the pilot found the integrand different from zero");
            return tally;
        }
        const std::vector<ChainTrace>& traces = state_.walkers.traces;
        const double z = state_.normalisation.mean(), z_variance = state_.normalisation.variance_of_mean();
        std::vector<ChainSummary> means;
        for (std::size_t c = 0; c < m; ++c) {
            means.push_back(summarize(traces, static_cast<int>(c)));
            const ChainSummary& h = means.back();
            tally.value[c] = z * h.mean;
            tally.standard_error[c] =
                std::sqrt(z * z * h.standard_error * h.standard_error + h.mean * h.mean * z_variance);
        }
        if (problem_.full_covariance) {
            tally.covariance.resize(m * m);
            for (std::size_t a = 0; a < m; ++a)
                for (std::size_t b = 0; b <= a; ++b) {
                    const double r =
                        a == b ? 1 : correlation_of_means(traces, static_cast<int>(a), static_cast<int>(b));
                    // The same number in both places, since sums in another order round differently.
                    tally.covariance[a * m + b] = tally.covariance[b * m + a] =
                        z * z * r * means[a].standard_error * means[b].standard_error +
                        means[a].mean * means[b].mean * z_variance;
                }
        }
        add_warnings(tally);
        return tally;
    }

    void save(StateWriter& state) const override {
        state.put(static_cast<std::uint64_t>(state_.walkers.chains.size()));
        for (const WalkingChain& chain : state_.walkers.chains) {
            state.put(chain.u);
            state.put(chain.mean);
            state.put(chain.size);
        }
        for (const ChainTrace& trace : state_.walkers.traces) trace.save(state);
        state.put(state_.walkers.inverse_scale);
        state_.density.save(state);
        state.put(state_.walkers.step);
        state.put(state_.steps);
        state.put(state_.evaluations);
        montelux::save(state, state_.non_finite);
        state.put(state_.normalisation.count());
        state.put(state_.normalisation.mean());
        state.put(state_.normalisation.squared_deviations()[0]);
        state.put(state_.largest);
        state.put(state_.accepted);
        state.put(state_.proposed);
    }

    void load(StateReader& state) override {
        State loaded;
        const std::uint64_t chains = state.get_word();
        if (chains != 0 && chains != static_cast<std::uint64_t>(settings_.chains))
            throw Error("the saved state has another number of chains");
        for (std::uint64_t c = 0; c < chains; ++c) {
            WalkingChain chain;
            chain.u = state.get_doubles();
            chain.mean = state.get_doubles();
            chain.size = state.get_double();
            if (chain.u.size() != static_cast<std::size_t>(problem_.evaluator.dimensions()) ||
                chain.mean.size() != static_cast<std::size_t>(problem_.evaluator.components()))
                throw Error("the saved state has another number of dimensions or components");
            loaded.walkers.chains.push_back(std::move(chain));
        }
        loaded.walkers.traces.assign(chains, ChainTrace(observables()));
        for (ChainTrace& trace : loaded.walkers.traces) trace.load(state);
        loaded.walkers.inverse_scale = state.get_doubles();
        loaded.density.load(state);
        loaded.walkers.factor = loaded.density.factor();
        loaded.walkers.step = state.get_double();
        loaded.steps = state.get<std::uint32_t>();
        loaded.evaluations = state.get_word();
        montelux::load(state, loaded.non_finite);
        const std::uint64_t count = state.get_word();
        const double mean = state.get_double();
        const double squares = state.get_double();
        loaded.normalisation = RunningMoments(count, mean, squares);
        loaded.largest = state.get_double();
        loaded.accepted = state.get_word();
        loaded.proposed = state.get_word();
        state_ = std::move(loaded);
    }

  private:
    int observables() const { return Walkers::observables(problem_.evaluator); }
    // Whether any chain has seen g / s differ.
    bool varied() const {
        const ChainTrace& first = state_.walkers.traces[0];
        for (const ChainTrace& trace : state_.walkers.traces)
            for (int c = 0; c < problem_.evaluator.components(); ++c)
                for (std::size_t i = 0; i < trace.batches(); ++i)
                    if (trace.squares(c, i) > 0 || trace.mean(c, i) != first.mean(c, 0)) return true;
        return false;
    }
    static void take(State& state, const WalkCounts& counts) {
        state.evaluations += counts.evaluations;
        state.non_finite.merge(counts.non_finite);
    }

    // Pilot, starts, burn-in and the fit of the importance density.
    StepOutcome start(const CancelFlag* cancel) {
        const Evaluator& g = problem_.evaluator;
        State next = state_;
        WalkCounts counts;
        PointBuffer u(settings_.pilot, g.dimensions());
        ValueBuffer values(settings_.pilot, g.components());
        fill_random(u, problem_.seed, pilot_stream, next.steps * settings_.pilot);
        g(u, values, counts.non_finite);
        counts.evaluations = settings_.pilot;
        const auto m = static_cast<std::size_t>(g.components());
        next.walkers.inverse_scale.assign(m, 1);
        for (std::size_t c = 0; m > 1 && c < m; ++c) {
            double square = 0;
            for (double v : std::as_const(values).component(static_cast<int>(c))) square += v * v;
            if (square > 0)
                next.walkers.inverse_scale[c] = 1 / std::sqrt(square / static_cast<double>(settings_.pilot));
        }
        std::vector<double> mean(m), sizes;
        double total = 0;
        for (std::size_t i = 0; i < u.count(); ++i) {
            sizes.push_back(component_ratios(values, i, next.walkers.inverse_scale, mean));
            total += sizes.back();
        }
        if (total > 0) {
            choose_starts(next, u, values, sizes, total);
            next.walkers.traces.assign(next.walkers.chains.size(), ChainTrace(observables()));
            if (!burn_in(next, counts, cancel)) return StepOutcome::cancelled;
        }
        take(next, counts);
        ++next.steps;
        state_ = std::move(next);
        return StepOutcome::advanced;
    }

    // In proportion to s, by systematic sampling.
    void choose_starts(State& next, const PointBuffer& u, const ValueBuffer& values,
                       const std::vector<double>& sizes, double total) const {
        PhiloxStream numbers(hash_key(problem_.seed, start_stream), {next.steps, 0, 0});
        const double offset = numbers.next_double();
        const PointBatch points = u.view();
        std::size_t i = 0;
        double sum = sizes[0];
        for (int k = 0; k < settings_.chains; ++k) {
            const double wanted = total * (offset + k) / settings_.chains;
            while (i + 1 < sizes.size() && (sum < wanted || sizes[i] == 0)) sum += sizes[++i];
            WalkingChain chain;
            chain.u.resize(static_cast<std::size_t>(points.dimensions()));
            points.gather(i, chain.u.data());
            chain.mean.resize(next.walkers.inverse_scale.size());
            chain.size = component_ratios(values, i, next.walkers.inverse_scale, chain.mean);
            next.walkers.chains.push_back(std::move(chain));
        }
        // The last point may be one where s = 0.
        for (std::size_t c = 1; c < next.walkers.chains.size(); ++c)
            if (next.walkers.chains[c].size == 0) next.walkers.chains[c] = next.walkers.chains[c - 1];
    }

    bool burn_in(State& next, WalkCounts& counts, const CancelFlag* cancel) const {
        const int d = problem_.evaluator.dimensions();
        CovarianceMoments spread(d), fit(d);
        for (const WalkingChain& chain : next.walkers.chains) spread.add(chain.u);
        const double target = d == 1 ? 0.44 : 0.234 + 0.206 / (d * d);
        next.walkers.step = 2.38 / std::sqrt(d);
        for (int window = 0; window < windows; ++window) {
            next.walkers.factor = StudentMixture(spread).factor();
            const std::uint64_t states =
                settings_.burn_in * (window + 1) / windows - settings_.burn_in * window / windows;
            CovarianceMoments seen(d);
            const auto part = next.walkers.walk(problem_, states, next.steps,
                                                static_cast<std::uint32_t>(window + 1), &seen, cancel);
            if (!part) return false;
            counts.merge(*part);
            const double rate = static_cast<double>(part->accepted) / static_cast<double>(part->proposed);
            next.walkers.step *= std::exp(2 * (rate - target));
            spread = seen;
            if (window >= windows / 2) fit.merge(seen);
        }
        next.density = StudentMixture(fit);
        next.walkers.factor = next.density.factor();
        return true;
    }

    // s / q at points of the importance density.
    std::optional<Normalisation> normalise(const State& next, std::uint64_t points,
                                           const CancelFlag* cancel) const {
        const Evaluator& g = problem_.evaluator;
        const auto d = static_cast<std::size_t>(g.dimensions());
        return sum_batches(
            points, [] { return Normalisation{}; },
            [&](std::uint64_t begin, std::uint64_t count, Normalisation& sum) {
                PhiloxStream numbers(hash_key(problem_.seed, normal_stream),
                                     {static_cast<std::uint32_t>(begin / batch_size), next.steps, 0});
                std::vector<double> x(d), points_in, densities,
                    mean(static_cast<std::size_t>(g.components()));
                for (std::uint64_t i = 0; i < count; ++i) {
                    if (!next.density.sample(numbers, x)) continue;
                    points_in.insert(points_in.end(), x.begin(), x.end());
                    densities.push_back(next.density.density(x));
                }
                PointBuffer u(densities.size(), g.dimensions());
                ValueBuffer values(densities.size(), g.components());
                for (std::size_t i = 0; i < densities.size(); ++i)
                    for (std::size_t k = 0; k < d; ++k) u(i, static_cast<int>(k)) = points_in[i * d + k];
                if (!densities.empty()) g(u, values, sum.counts.non_finite);
                sum.counts.evaluations += densities.size();
                for (std::size_t i = 0; i < densities.size(); ++i) {
                    const double w =
                        component_ratios(values, i, next.walkers.inverse_scale, mean) / densities[i];
                    sum.moments.add(w);
                    sum.largest = std::max(sum.largest, w);
                }
                for (std::uint64_t i = densities.size(); i < count; ++i) sum.moments.add(0);
            },
            cancel);
    }

    void add_warnings(Tally& tally) const {
        char text[192];
        double worst = 0;
        for (int k = 0; k < observables(); ++k)
            worst = std::max(worst, split_r_hat(state_.walkers.traces, k));
        if (worst > converged) {
            std::snprintf(
                text, sizeof text,
                "the chains have not converged to one density: split R-hat %.3f, expected at most 1.01",
                worst);
            tally.warnings.emplace_back(text);
        }
        const double n = static_cast<double>(state_.normalisation.count());
        const double squares = state_.normalisation.squared_deviations()[0] +
                               n * state_.normalisation.mean() * state_.normalisation.mean();
        if (n > 1000 && state_.largest * state_.largest > concentrated * squares) {
            std::snprintf(
                text, sizeof text,
                "one of %.0f points has %.0f %% of the sum of squares of the normalisation; the error "
                "may be too small",
                n, 100 * std::min(1.0, state_.largest * state_.largest / squares));
            tally.warnings.emplace_back(text);
        }
    }

    Problem problem_;
    Metropolis settings_;
    State state_;
};

} // namespace

std::unique_ptr<Estimator> Metropolis::estimator(const Problem& problem) const {
    return std::make_unique<MetropolisEstimator>(problem, *this);
}

} // namespace montelux
