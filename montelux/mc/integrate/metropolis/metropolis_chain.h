// Metropolis-Hastings (A8): Markov chains whose density is known only up to a constant.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/metropolis/acceptance.h"
#include "montelux/mc/integrate/metropolis/chain_trace.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/vec.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {

// log p(x) up to a constant; -infinity where the density is zero.
template <typename F>
concept LogDensity = requires(const F& f, std::span<const double> x) {
    { f(x) } -> std::convertible_to<double>;
};

// Draws a proposal y from q(y | x) with numbers of the stream and returns log q(x | y) - log q(y | x): zero
// for symmetric proposals. Empty: no proposal, and the chain stays.
template <typename P>
concept ProposalFunction = requires(const P& propose, PhiloxStream& numbers, std::span<const double> x,
                                    std::span<double> y) {
    { propose(numbers, x, y) } -> std::convertible_to<std::optional<double>>;
};

// log p from a density p (up to a constant); a negative or NaN density is counted as not finite.
template <typename F>
auto log_of(F density) {
    return [density = std::move(density)](std::span<const double> x) {
        const double p = density(x);
        return p == 0 ? -std::numeric_limits<double>::infinity() : std::log(p);
    };
}

// y = x + step * scale_d * z_d, z standard normal: symmetric. During burn-in each chain adapts `scale` to the
// spread of each coordinate, and `step` to an acceptance of 0.44 in one dimension and 0.234 in many (Roberts
// and Rosenthal 2001, "Optimal Scaling for Various Metropolis-Hastings Algorithms"); after it both stay.
struct GaussianWalk {
    double step = 0;                // at first; 0: 2.38 / sqrt(dimensions)
    std::vector<double> scale = {}; // of each coordinate at first; empty: 1
    bool adapt = true;
};

struct MetropolisOptions {
    int chains = 4;
    std::uint64_t burn_in = 2000;  // discarded states of each chain
    std::uint64_t samples = 20000; // states of each chain after it
    std::uint64_t thin = 1;        // every thin-th state goes to `visit`
    std::uint64_t seed = 0;
    const CancelFlag* cancel = nullptr;
};

struct MetropolisResult {
    // One for each observable.
    std::vector<ChainSummary> observables;
    double acceptance_rate = 0;
    std::uint64_t evaluations = 0; // of the density
    std::uint64_t non_finite = 0;  // densities that were NaN or +infinity, and were rejected
    bool cancelled = false;
    std::vector<std::string> warnings;
};

namespace detail {

// Two independent standard normal numbers (Box and Muller 1958).
inline Vec2d draw_normals(PhiloxStream& numbers) {
    const double u = numbers.next_double();
    const double v = numbers.next_double();
    const double radius = std::sqrt(-2 * std::log(1 - u)), angle = 2 * pi * v;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

// The walk of one chain, as it adapts.
class AdaptedWalk {
  public:
    AdaptedWalk(const GaussianWalk& settings, int dimensions, std::uint64_t burn_in);

    std::optional<double> operator()(PhiloxStream& numbers, std::span<const double> x,
                                     std::span<double> y) const {
        for (std::size_t d = 0; d < x.size(); d += 2) {
            const Vec2d z = draw_normals(numbers);
            y[d] = x[d] + step_ * scale_[d] * z.x;
            if (d + 1 < x.size()) y[d + 1] = x[d + 1] + step_ * scale_[d + 1] * z.y;
        }
        return 0;
    }
    // After each state of the burn-in, with the probability that its proposal had.
    void learn(std::span<const double> x, double acceptance);
    double step() const { return step_; }

  private:
    bool adapt_;
    double step_, target_;
    std::vector<double> scale_;
    std::vector<RunningMoments> moments_;
    std::uint64_t burn_in_, seen_ = 0, window_end_ = 0, since_window_ = 0;
};

struct ChainOutcome {
    std::uint64_t accepted = 0, evaluations = 0, non_finite = 0;
};

void check(const MetropolisOptions& options, const std::vector<std::vector<double>>& starts, int observables);
// Combines the traces and counts.
MetropolisResult gather(const std::vector<ChainTrace>& traces, const std::vector<ChainOutcome>& outcomes,
                        const MetropolisOptions& options, bool cancelled);

template <typename Density, typename Propose, typename Learn, typename Observe, typename Visit>
ChainOutcome run_chain(const Density& log_density, const Propose& propose, const Learn& learn,
                       const Observe& observe, const Visit& visit, std::vector<double> x, int chain,
                       ChainTrace& trace, const MetropolisOptions& options) {
    constexpr double nothing = -std::numeric_limits<double>::infinity();
    ChainOutcome outcome;
    const std::uint64_t key = hash_key(options.seed, 0x6d6574726f706f6cu);
    PhiloxStream numbers(key);
    std::vector<double> y(x.size()), values(static_cast<std::size_t>(trace.observables()));
    auto density = [&](std::span<const double> at) {
        ++outcome.evaluations;
        const double log_p = log_density(at);
        if (log_p < std::numeric_limits<double>::infinity()) return log_p;
        ++outcome.non_finite;
        return nothing;
    };
    double current = density(x);
    if (current == nothing)
        throw Error("metropolis",
                    "the density is zero, or not a number, where chain " + std::to_string(chain) + " starts");
    const std::uint64_t states = options.burn_in + options.samples;
    for (std::uint64_t t = 0; t < states; ++t) {
        if (options.cancel && (t & 1023) == 0 && options.cancel->requested()) break;
        // A stream lasts for 2^34 numbers; a fresh one for every 2^16 states never ends.
        if ((t & 0xffff) == 0)
            numbers =
                PhiloxStream(key, {static_cast<std::uint32_t>(chain), static_cast<std::uint32_t>(t >> 16),
                                   static_cast<std::uint32_t>(t >> 48)});
        const std::optional<double> log_ratio = propose(numbers, x, y);
        double acceptance = 0;
        if (log_ratio) {
            const double proposed = density(y);
            acceptance = proposed == nothing ? 0 : acceptance_of_log_ratio(proposed - current + *log_ratio);
            const double u = numbers.next_double();
            if (u < acceptance) {
                x.swap(y);
                current = proposed;
                if (t >= options.burn_in) ++outcome.accepted;
            }
        }
        if (t < options.burn_in) {
            learn(x, acceptance);
            continue;
        }
        observe(std::span<const double>(x), std::span<double>(values));
        trace.add(values);
        const std::uint64_t index = t - options.burn_in;
        if (index % options.thin == 0) visit(chain, index / options.thin, std::span<const double>(x));
    }
    return outcome;
}

} // namespace detail

// Runs the chains, each with random numbers of its own and all at once on the threads there are; the result
// does not depend on their number. `starts` holds one point for all chains, or one for each, where the
// density is not zero; widely spread points make R-hat meaningful. `observe(x, values)` fills the values of
// `observables` functions, whose means over the density are computed. `visit(chain, k, x)` gets every thin-th
// state, from the chain's thread. Functions are called from several threads at once. Throws Error for options
// and starts that make no sense.
//
// After the burn-in states follow p up to a remaining influence of the start; standard errors contain the
// autocorrelation, and a split R-hat above 1.01 gives a warning.
template <LogDensity Density, typename Propose, typename Observe, typename Visit>
requires(ProposalFunction<Propose> || std::same_as<Propose, GaussianWalk>) //
    MetropolisResult
    metropolis(const Density& log_density, const Propose& proposal,
               const std::vector<std::vector<double>>& starts, int observables, const Observe& observe,
               const Visit& visit, const MetropolisOptions& options = {}) {
    detail::check(options, starts, observables);
    const auto chains = static_cast<std::size_t>(options.chains);
    std::vector<ChainTrace> traces(chains, ChainTrace(observables));
    std::vector<detail::ChainOutcome> outcomes(chains);
    const bool complete = parallel_for(
        options.chains,
        [&](std::int64_t chain) {
            const auto c = static_cast<std::size_t>(chain);
            const std::vector<double>& start = starts[starts.size() == 1 ? 0 : c];
            const int number = static_cast<int>(chain);
            if constexpr (std::same_as<Propose, GaussianWalk>) {
                detail::AdaptedWalk walk(proposal, static_cast<int>(start.size()), options.burn_in);
                outcomes[c] = detail::run_chain(
                    log_density, walk, [&](auto x, double a) { walk.learn(x, a); }, observe, visit, start,
                    number, traces[c], options);
            } else {
                outcomes[c] = detail::run_chain(
                    log_density, proposal, [](auto, double) {}, observe, visit, start, number, traces[c],
                    options);
            }
        },
        options.cancel);
    return detail::gather(traces, outcomes, options,
                          !complete || (options.cancel && options.cancel->requested()));
}

template <LogDensity Density, typename Propose, typename Observe>
MetropolisResult metropolis(const Density& log_density, const Propose& proposal,
                            const std::vector<std::vector<double>>& starts, int observables,
                            const Observe& observe, const MetropolisOptions& options = {}) {
    return metropolis(
        log_density, proposal, starts, observables, observe,
        [](int, std::uint64_t, std::span<const double>) {}, options);
}

} // namespace montelux
