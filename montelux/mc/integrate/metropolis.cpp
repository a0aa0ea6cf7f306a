#include "montelux/mc/integrate/metropolis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "montelux/mc/integrate/chain_trace.h"
#include "montelux/mc/integrate/metropolis_chain.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/student_mixture.h"
#include "montelux/mc/integrate/unit_points.h"

namespace montelux {
namespace {

constexpr int group_size = 8; // chains whose proposals are evaluated together
constexpr int windows = 20;   // of the burn-in, between which the walk adapts
constexpr int watched_coordinates = 8;
constexpr std::uint64_t most_pilot_points = 1 << 22; // in search of a start
constexpr std::uint64_t first_step = 1 << 14, large_step = 1 << 20;
constexpr double converged = 1.01;
constexpr double concentrated = 0.1;
enum Stream : std::uint32_t { pilot_stream = 1, start_stream = 2, walk_stream = 3, normal_stream = 4 };

// One chain: where it is, the size s there, and g / s.
struct Chain {
    std::vector<double> u, mean;
    double size = 0;
};

struct Counts {
    std::uint64_t evaluations = 0, accepted = 0, proposed = 0;
    NonFiniteCount non_finite;

    void merge(const Counts& later) {
        evaluations += later.evaluations;
        accepted += later.accepted;
        proposed += later.proposed;
        non_finite.merge(later.non_finite);
    }
};

// Sums of s / q over the points of the importance density.
struct Normalisation {
    RunningMoments moments;
    double largest = 0;
    Counts counts;

    void merge(const Normalisation& later) {
        moments.merge(later.moments);
        largest = std::max(largest, later.largest);
        counts.merge(later.counts);
    }
};

struct State {
    std::vector<Chain> chains;      // empty before the pilot has found where s > 0
    std::vector<ChainTrace> traces; // of the chains
    std::vector<double> inverse_scale;
    StudentMixture density;
    double step = 0;
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
        if (state_.chains.empty()) {
            if (request.max_evaluations < settings_.pilot + chains * settings_.burn_in)
                return StepOutcome::exhausted;
            // Nothing to walk on.
            if (state_.evaluations >= most_pilot_points) return StepOutcome::finished;
            return start(request.cancel);
        }
        const double done = static_cast<double>(state_.evaluations);
        std::uint64_t size = next_step_size(static_cast<std::uint64_t>(done), first_step, large_step);
        size = std::min(size, request.max_evaluations);
        // The chains say nothing of g / s where it is always the same; an eighth then watches on.
        const std::uint64_t walked = varied() ? size / 2 : size / 8;
        const std::uint64_t states = walked / chains;
        if (states == 0) return StepOutcome::exhausted;
        State next = state_;
        auto counts = walk(next, states, 0, nullptr, request.cancel);
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
            if (state_.evaluations > 0 && state_.chains.empty())
                tally.doubts.emplace_back("no point of the pilot found the integrand different from zero");
            return tally;
        }
        const std::vector<ChainTrace>& traces = state_.traces;
        const double z = state_.normalisation.mean(), z_variance = state_.normalisation.variance_of_mean();
        std::vector<ChainSummary> means;
        for (std::size_t c = 0; c < m; ++c) {
            means.push_back(summarize(traces, static_cast<int>(c)));
            const ChainSummary& h = means.back();
            tally.value[c] = z * h.mean;
            tally.standard_error[c] =
                std::sqrt(z * z * h.standard_error * h.standard_error + h.mean * h.mean * z_variance);
        }
        if (problem_.full_covariance)
            for (std::size_t a = 0; a < m; ++a)
                for (std::size_t b = 0; b < m; ++b) {
                    const double r = a == b ? 1
                                            : correlation_of_means(traces, static_cast<int>(std::max(a, b)),
                                                                   static_cast<int>(std::min(a, b)));
                    tally.covariance.push_back(z * z * r * means[a].standard_error * means[b].standard_error +
                                               means[a].mean * means[b].mean * z_variance);
                }
        add_doubts(tally);
        return tally;
    }

    void save(StateWriter& state) const override {
        state.put(static_cast<std::uint64_t>(state_.chains.size()));
        for (const Chain& chain : state_.chains) {
            state.put(chain.u);
            state.put(chain.mean);
            state.put(chain.size);
        }
        for (const ChainTrace& trace : state_.traces) trace.save(state);
        state.put(state_.inverse_scale);
        state_.density.save(state);
        state.put(state_.step);
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
            Chain chain;
            chain.u = state.get_doubles();
            chain.mean = state.get_doubles();
            chain.size = state.get_double();
            if (chain.u.size() != static_cast<std::size_t>(problem_.evaluator.dimensions()) ||
                chain.mean.size() != static_cast<std::size_t>(problem_.evaluator.components()))
                throw Error("the saved state has another number of dimensions or components");
            loaded.chains.push_back(std::move(chain));
        }
        loaded.traces.assign(chains, ChainTrace(observables()));
        for (ChainTrace& trace : loaded.traces) trace.load(state);
        loaded.inverse_scale = state.get_doubles();
        loaded.density.load(state);
        loaded.step = state.get_double();
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
    // Means g_c / s, then log s, then coordinates.
    int observables() const {
        return problem_.evaluator.components() + 1 +
               std::min(watched_coordinates, problem_.evaluator.dimensions());
    }
    // Whether any chain has seen g / s differ.
    bool varied() const {
        const ChainTrace& first = state_.traces[0];
        for (const ChainTrace& trace : state_.traces)
            for (int c = 0; c < problem_.evaluator.components(); ++c)
                for (std::size_t i = 0; i < trace.batches(); ++i)
                    if (trace.squares(c, i) > 0 || trace.mean(c, i) != first.mean(c, 0)) return true;
        return false;
    }
    static void take(State& state, const Counts& counts) {
        state.evaluations += counts.evaluations;
        state.non_finite.merge(counts.non_finite);
    }

    // s at point i, and g / s.
    static double size_of(const ValueBuffer& g, std::size_t i, const std::vector<double>& inverse_scale,
                          std::vector<double>& mean) {
        double size = 0;
        for (std::size_t c = 0; c < mean.size(); ++c) {
            mean[c] = g(i, static_cast<int>(c));
            size += mean[c] * inverse_scale[c] * mean[c] * inverse_scale[c];
        }
        size = mean.size() == 1 ? std::abs(mean[0]) * inverse_scale[0] : std::sqrt(size);
        if (size > 0)
            for (double& h : mean) h /= size;
        return size;
    }

    // Pilot, starts, burn-in and the fit of the importance density.
    StepOutcome start(const CancelFlag* cancel) {
        const Evaluator& g = problem_.evaluator;
        State next = state_;
        Counts counts;
        PointBuffer u(settings_.pilot, g.dimensions());
        ValueBuffer values(settings_.pilot, g.components());
        fill_random(u, problem_.seed, pilot_stream, next.steps * settings_.pilot);
        g(u, values, counts.non_finite);
        counts.evaluations = settings_.pilot;
        const auto m = static_cast<std::size_t>(g.components());
        next.inverse_scale.assign(m, 1);
        for (std::size_t c = 0; m > 1 && c < m; ++c) {
            double square = 0;
            for (double v : std::as_const(values).component(static_cast<int>(c))) square += v * v;
            if (square > 0)
                next.inverse_scale[c] = 1 / std::sqrt(square / static_cast<double>(settings_.pilot));
        }
        std::vector<double> mean(m), sizes;
        double total = 0;
        for (std::size_t i = 0; i < u.count(); ++i) {
            sizes.push_back(size_of(values, i, next.inverse_scale, mean));
            total += sizes.back();
        }
        if (total > 0) {
            choose_starts(next, u, values, sizes, total);
            next.traces.assign(next.chains.size(), ChainTrace(observables()));
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
            Chain chain;
            chain.u.resize(static_cast<std::size_t>(points.dimensions()));
            points.gather(i, chain.u.data());
            chain.mean.resize(next.inverse_scale.size());
            chain.size = size_of(values, i, next.inverse_scale, chain.mean);
            next.chains.push_back(std::move(chain));
        }
        // The last point may be one where s = 0.
        for (std::size_t c = 1; c < next.chains.size(); ++c)
            if (next.chains[c].size == 0) next.chains[c] = next.chains[c - 1];
    }

    bool burn_in(State& next, Counts& counts, const CancelFlag* cancel) const {
        const int d = problem_.evaluator.dimensions();
        CovarianceMoments spread(d), fit(d);
        for (const Chain& chain : next.chains) spread.add(chain.u);
        const double target = d == 1 ? 0.44 : 0.234 + 0.206 / (d * d);
        next.step = 2.38 / std::sqrt(d);
        for (int window = 0; window < windows; ++window) {
            next.density = StudentMixture(spread);
            const std::uint64_t states =
                settings_.burn_in * (window + 1) / windows - settings_.burn_in * window / windows;
            CovarianceMoments seen(d);
            const auto part = walk(next, states, static_cast<std::uint32_t>(window + 1), &seen, cancel);
            if (!part) return false;
            counts.merge(*part);
            const double rate = static_cast<double>(part->accepted) / static_cast<double>(part->proposed);
            next.step *= std::exp(2 * (rate - target));
            spread = seen;
            if (window >= windows / 2) fit.merge(seen);
        }
        next.density = StudentMixture(fit);
        return true;
    }

    // Moves all chains by so many states; traces them, or gathers the points of a window of the burn-in
    // (whose number, from 1, keys its random numbers).
    std::optional<Counts> walk(State& next, std::uint64_t states, std::uint32_t window,
                               CovarianceMoments* seen, const CancelFlag* cancel) const {
        const int groups = (settings_.chains + group_size - 1) / group_size;
        struct Part {
            Counts counts;
            CovarianceMoments seen;
        };
        auto part = parallel_reduce_ordered(
            groups,
            [&](std::int64_t group) {
                Part own{{}, CovarianceMoments(seen ? problem_.evaluator.dimensions() : 0)};
                walk_group(next, static_cast<int>(group) * group_size, states, window,
                           seen ? &own.seen : nullptr, own.counts);
                return own;
            },
            [](Part a, const Part& b) {
                a.counts.merge(b.counts);
                a.seen.merge(b.seen);
                return a;
            },
            cancel);
        if (!part) return std::nullopt;
        if (seen) *seen = part->seen;
        return part->counts;
    }

    void walk_group(State& next, int first, std::uint64_t states, std::uint32_t window,
                    CovarianceMoments* seen, Counts& counts) const {
        const Evaluator& g = problem_.evaluator;
        const auto d = static_cast<std::size_t>(g.dimensions());
        const int lanes = std::min(group_size, settings_.chains - first);
        const std::vector<double>& factor = next.density.factor();
        std::vector<PhiloxStream> numbers;
        for (int l = 0; l < lanes; ++l)
            numbers.emplace_back(
                hash_key(problem_.seed, walk_stream),
                std::array<std::uint32_t, 3>{static_cast<std::uint32_t>(first + l), next.steps, window});
        PointBuffer u;
        ValueBuffer values;
        std::vector<double> normals(d + 1), proposed(d), mean(static_cast<std::size_t>(g.components())),
            observed(static_cast<std::size_t>(observables()));
        std::vector<std::vector<double>> inside;
        std::vector<int> lane;
        for (std::uint64_t t = 0; t < states; ++t) {
            lane.clear();
            inside.resize(static_cast<std::size_t>(lanes));
            for (int l = 0; l < lanes; ++l) {
                PhiloxStream& stream = numbers[static_cast<std::size_t>(l)];
                for (std::size_t k = 0; k < d; k += 2) {
                    const Vec2d z = detail::draw_normals(stream);
                    normals[k] = z.x;
                    normals[k + 1] = z.y;
                }
                const Chain& chain = next.chains[static_cast<std::size_t>(first + l)];
                bool in = true;
                for (std::size_t i = 0; i < d; ++i) {
                    double sum = 0;
                    for (std::size_t k = 0; k <= i; ++k) sum += factor[i * d + k] * normals[k];
                    proposed[i] = chain.u[i] + next.step * sum;
                    in = in && proposed[i] > 0 && proposed[i] < 1;
                }
                if (!in) continue; // s is zero outside of the cube: the chain stays
                inside[lane.size()] = proposed;
                lane.push_back(l);
            }
            u.resize(lane.size(), g.dimensions());
            values.resize(lane.size(), g.components());
            for (std::size_t i = 0; i < lane.size(); ++i)
                for (std::size_t k = 0; k < d; ++k) u(i, static_cast<int>(k)) = inside[i][k];
            if (!lane.empty()) g(u, values, counts.non_finite);
            counts.evaluations += lane.size();
            counts.proposed += static_cast<std::uint64_t>(lanes);
            for (std::size_t i = 0; i < lane.size(); ++i) {
                Chain& chain = next.chains[static_cast<std::size_t>(first + lane[i])];
                const double size = size_of(values, i, next.inverse_scale, mean);
                const double number = numbers[static_cast<std::size_t>(lane[i])].next_double();
                if (!(number * chain.size < size)) continue;
                chain.u.swap(inside[i]);
                chain.mean = mean;
                chain.size = size;
                ++counts.accepted;
            }
            for (int l = 0; l < lanes; ++l) {
                Chain& chain = next.chains[static_cast<std::size_t>(first + l)];
                if (seen) seen->add(chain.u);
                if (window > 0) continue;
                std::copy(chain.mean.begin(), chain.mean.end(), observed.begin());
                observed[mean.size()] = std::log(chain.size);
                for (std::size_t k = mean.size() + 1; k < observed.size(); ++k)
                    observed[k] = chain.u[k - mean.size() - 1];
                next.traces[static_cast<std::size_t>(first + l)].add(observed);
            }
        }
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
                    const double w = size_of(values, i, next.inverse_scale, mean) / densities[i];
                    sum.moments.add(w);
                    sum.largest = std::max(sum.largest, w);
                }
                for (std::uint64_t i = densities.size(); i < count; ++i) sum.moments.add(0);
            },
            cancel);
    }

    void add_doubts(Tally& tally) const {
        char text[192];
        double worst = 0;
        for (int k = 0; k < observables(); ++k) worst = std::max(worst, split_r_hat(state_.traces, k));
        if (worst > converged) {
            std::snprintf(
                text, sizeof text,
                "the chains have not converged to one density: split R-hat %.3f, expected at most 1.01",
                worst);
            tally.doubts.emplace_back(text);
        }
        const double n = static_cast<double>(state_.normalisation.count());
        const double squares = state_.normalisation.squared_deviations()[0] +
                               n * state_.normalisation.mean() * state_.normalisation.mean();
        if (n > 1000 && state_.largest * state_.largest > concentrated * squares) {
            std::snprintf(
                text, sizeof text,
                "one of %.0f points has %.0f %% of the sum of squares of the normalisation; the error "
                "may be too small",
                n, 100 * state_.largest * state_.largest / squares);
            tally.doubts.emplace_back(text);
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
