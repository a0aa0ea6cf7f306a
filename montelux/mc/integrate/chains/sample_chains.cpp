#include "montelux/mc/integrate/chains/sample_chains.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "montelux/mc/integrate/chains/chain_starts.h"
#include "montelux/mc/integrate/chains/walker_ensemble.h"
#include "montelux/mc/integrate/metropolis/metropolis_chain.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/physical_memory.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr double converged_r_hat = 1.01;    // Vehtari et al. 2021
constexpr double few_effective_draws = 100; // for each of the independent chains
// Huijser, Goodman, Brewer 2015, "Properties of the Affine Invariant Ensemble Sampler in High Dimensions".
constexpr int most_stretch_dimensions = 50;
constexpr int most_chains = 10000, most_walkers = 100000;

// Options with every default decided.
struct ChainPlan {
    const Integrand& log_density;
    const Domain& domain;
    const ChainOptions& options;
    std::size_t dimensions, walkers;
    std::vector<std::string> names;

    std::size_t chains() const { return static_cast<std::size_t>(options.chains); }
    LogDensityCalls calls() const { return {log_density, domain.ranges()}; }
    std::vector<double> starts(LogDensityCalls& density, std::size_t chain) const;
};

void expect_option(bool good, const std::string& what) {
    if (!good) throw Error("chains", what);
}

// Before hours of sampling, not after them: the states, and what starts and diagnostics take beside them.
void expect_memory(const ChainOptions& options, std::uint64_t sequences, std::size_t walkers,
                   std::size_t dimensions) {
    const auto d = static_cast<double>(dimensions), threads = static_cast<double>(thread_count());
    const double column = static_cast<double>(sequences * options.draws);
    // Of a variable: its values, their halves, their ranks and a working copy, and a chain's Fourier transform.
    const double diagnostics = (4 + 4 / static_cast<double>(sequences)) * column * std::min(threads, d);
    // Of an ensemble: random points of the unit cube and of the domain, four for each walker.
    const double starts = 12 * static_cast<double>(walkers) * d * std::min(threads, 1.0 * options.chains);
    const double needed = sizeof(double) * (column * d + std::max(diagnostics, starts));
    if (needed <= physical_memory()) return;
    constexpr double gib = 1 << 30;
    char text[256];
    std::snprintf(
        text, sizeof text,
        "%llu draws of %llu chains or walkers in %zu variables need %.1f GiB of memory; this machine "
        "has %.1f GiB; expected fewer draws, further apart (--thin, thin), or fewer chains",
        static_cast<unsigned long long>(options.draws), static_cast<unsigned long long>(sequences),
        dimensions, needed / gib, physical_memory() / gib);
    throw Error("chains", text);
}

ChainPlan planned(const Integrand& log_density, const Domain& domain, const ChainOptions& options) {
    expect_option(!domain.ranges().empty(),
                  "expected a box of ranges as domain, got " + domain.description());
    expect_option(log_density.components() == 1, "expected a log density of one component");
    const int d = domain.dimensions();
    expect_option(log_density.fixed_dimensions() == 0 || log_density.fixed_dimensions() == d,
                  "a function of one number was given for " + std::to_string(d) + " variables");
    expect_option(options.chains >= 1 && options.chains <= most_chains,
                  "expected 1 to " + std::to_string(most_chains) + " chains");
    expect_option(options.draws >= 8, "expected at least 8 draws of a chain");
    expect_option(options.thin >= 1, "expected a thinning of at least 1");
    ChainPlan plan{log_density, domain, options, static_cast<std::size_t>(d), 1, options.names};
    if (options.sampler == ChainSampler::metropolis) {
        expect_option(options.walkers == 0,
                      "chains of metropolis have no walkers; expected ensemble or slice");
    } else {
        const int walkers = walkers_of(options, d), fewest = fewest_walkers(d);
        expect_option(walkers >= fewest && walkers <= most_walkers,
                      std::to_string(walkers) + " walkers were given for " + std::to_string(d) +
                          " variables; expected " + std::to_string(fewest) + " to " +
                          std::to_string(most_walkers));
        plan.walkers = static_cast<std::size_t>(walkers);
    }
    const std::uint64_t sequences = plan.chains() * plan.walkers;
    expect_option(options.draws <= (std::uint64_t{1} << 40) / sequences / plan.dimensions,
                  "all draws together have more than 2^40 numbers");
    constexpr std::uint64_t most_states = std::uint64_t{1} << 62;
    expect_option(
        options.burn_in <= most_states && options.thin <= most_states / options.draws,
        "a chain has more than 2^62 states; expected fewer draws, or a smaller thinning or burn-in");
    expect_memory(options, sequences, plan.walkers, plan.dimensions);
    const std::size_t starts = options.starts.size();
    expect_option(starts <= 1 || starts == plan.chains() || starts == sequences,
                  std::to_string(starts) + " starts were given for " + std::to_string(plan.chains()) +
                      " chains of " + std::to_string(plan.walkers) +
                      " walkers; expected one, or one for each");
    for (const std::vector<double>& start : options.starts) {
        expect_option(start.size() == plan.dimensions, std::to_string(start.size()) +
                                                           " numbers were given as a start of " +
                                                           std::to_string(d) + " variables");
        for (double x : start) expect_option(std::isfinite(x), "expected starts of finite numbers");
    }
    expect_option(plan.names.empty() || plan.names.size() == plan.dimensions,
                  "expected a name for each of " + std::to_string(d) + " variables");
    for (int k = 0; options.names.empty() && k < d; ++k) plan.names.push_back("x" + std::to_string(k + 1));
    return plan;
}

std::vector<double> ChainPlan::starts(LogDensityCalls& density, std::size_t chain) const {
    const auto& given = options.starts;
    const auto number = static_cast<std::uint32_t>(chain);
    if (given.empty()) return random_starts(density, domain, walkers, options.seed, number);
    if (given.size() == chains() * walkers) {
        std::vector<double> all;
        for (std::size_t w = chain * walkers; w < (chain + 1) * walkers; ++w)
            all.insert(all.end(), given[w].begin(), given[w].end());
        return all;
    }
    return scattered_starts(density, given[given.size() == 1 ? 0 : chain], domain, walkers, options.seed,
                            number);
}

void run_walks(const ChainPlan& plan, ChainDraws& result) {
    const std::size_t n = plan.dimensions;
    MetropolisOptions options;
    options.chains = plan.options.chains;
    options.burn_in = plan.options.burn_in;
    options.thin = plan.options.thin;
    options.samples = plan.options.draws * plan.options.thin;
    options.seed = plan.options.seed;
    options.cancel = plan.options.cancel;
    std::vector<std::vector<double>> starts;
    LogDensityCalls density = plan.calls();
    for (std::size_t c = 0; c < plan.chains(); ++c) starts.push_back(plan.starts(density, c));
    const MetropolisResult run = metropolis(
        [&](std::span<const double> x) {
            if (!LogDensityCalls::inside(plan.domain.ranges(), x))
                return -std::numeric_limits<double>::infinity();
            double y = 0;
            plan.log_density(PointBatch(x.data(), 1, static_cast<int>(n), 1), ValueBatch(&y, 1, 1, 1));
            return y;
        },
        GaussianWalk{}, starts, 1,
        [](std::span<const double> x, std::span<double> values) { values[0] = x[0]; },
        [&](int chain, std::uint64_t k, std::span<const double> x) {
            const std::uint64_t at = static_cast<std::uint64_t>(chain) * result.draws + k;
            std::copy(x.begin(), x.end(), result.states.begin() + static_cast<std::ptrdiff_t>(at * n));
        },
        options);
    result.acceptance_rate = run.acceptance_rate;
    result.evaluations = run.evaluations + density.evaluations();
    result.non_finite = run.non_finite + density.non_finite();
    result.cancelled = run.cancelled;
}

void run_ensembles(const ChainPlan& plan, ChainDraws& result) {
    struct Counts {
        std::uint64_t moved = 0, evaluations = 0, non_finite = 0;
        bool complete = false;
    };
    const ChainOptions& o = plan.options;
    const auto move = o.sampler == ChainSampler::slice ? EnsembleMove::slice : EnsembleMove::stretch;
    const std::uint64_t key = hash_key(o.seed, 0x656e73656d626c65u);
    std::vector<Counts> counts(plan.chains());
    parallel_for(
        o.chains,
        [&](std::int64_t chain) {
            const auto c = static_cast<std::size_t>(chain);
            LogDensityCalls density = plan.calls();
            std::vector<double> starts = plan.starts(density, c);
            expect_spanning_starts(starts, plan.dimensions, move == EnsembleMove::slice,
                                   static_cast<std::uint32_t>(c));
            WalkerEnsemble ensemble(move, density, std::move(starts), key, static_cast<std::uint32_t>(c));
            const std::uint64_t steps = o.burn_in + o.draws * o.thin;
            for (std::uint64_t t = 0; t < steps; ++t) {
                if (o.cancel && o.cancel->requested()) return;
                if (t == o.burn_in) ensemble.reset_counts();
                ensemble.step(t < o.burn_in);
                if (t < o.burn_in || (t - o.burn_in) % o.thin != 0) continue;
                const std::uint64_t draw = (t - o.burn_in) / o.thin;
                for (std::size_t w = 0; w < plan.walkers; ++w) {
                    const auto x = ensemble.walker(w);
                    const std::uint64_t at = (c * plan.walkers + w) * o.draws + draw;
                    std::copy(x.begin(), x.end(),
                              result.states.begin() + static_cast<std::ptrdiff_t>(at * plan.dimensions));
                }
            }
            counts[c] = {ensemble.moved(), ensemble.density().evaluations(), ensemble.density().non_finite(),
                         true};
        },
        o.cancel);
    std::uint64_t moved = 0;
    for (const Counts& c : counts) {
        moved += c.moved;
        result.evaluations += c.evaluations;
        result.non_finite += c.non_finite;
        result.cancelled = result.cancelled || !c.complete;
    }
    result.acceptance_rate = static_cast<double>(moved) / static_cast<double>(o.draws * o.thin) /
                             static_cast<double>(result.chains);
}

void summarize_all(const ChainPlan& plan, ChainDraws& result) {
    const std::uint64_t count = result.chains * result.draws;
    result.variables.resize(plan.dimensions);
    parallel_for(static_cast<std::int64_t>(plan.dimensions), [&](std::int64_t variable) {
        const auto k = static_cast<std::size_t>(variable);
        std::vector<double> values(count);
        for (std::uint64_t i = 0; i < count; ++i) values[i] = result.states[i * plan.dimensions + k];
        result.variables[k] = summarize_draws(values, result.chains, plan.walkers);
    });
}

void add_warnings(const ChainPlan& plan, ChainDraws& result) {
    auto warn = [&](const char* format, auto... values) {
        char text[256];
        std::snprintf(text, sizeof text, format, values...);
        result.warnings.emplace_back(text);
    };
    // The worst variable by name, and how many there are.
    const double expected = few_effective_draws * plan.options.chains;
    std::size_t disagree = 0, few = 0, most = 0, fewest = 0;
    auto size = [&](std::size_t k) {
        return std::min(result.variables[k].bulk_effective_size, result.variables[k].tail_effective_size);
    };
    std::size_t constant = 0, first_constant = 0, varied = 0;
    for (std::size_t k = 0; k < plan.dimensions; ++k) {
        const DrawSummary& summary = result.variables[k];
        if (summary.standard_deviation == 0 &&
            std::isinf(summary.standard_error)) { // has a sentence of its own
            if (constant++ == 0) first_constant = k;
            continue;
        }
        if (varied++ == 0) most = fewest = k;
        if (!(result.variables[k].r_hat <= converged_r_hat)) ++disagree;
        if (!(size(k) >= expected)) ++few;
        if (result.variables[k].r_hat > result.variables[most].r_hat) most = k;
        if (size(k) < size(fewest)) fewest = k;
    }
    auto others = [&](std::size_t count) {
        if (plan.dimensions == 1) return std::string();
        return " (so in " + std::to_string(count) + " of " + std::to_string(plan.dimensions) + " variables)";
    };
    for (std::size_t k = 0; k < plan.dimensions; ++k)
        if (!std::isfinite(result.variables[k].standard_deviation)) {
            warn("the draws of '%.40s' run to infinity; the density seems to have no finite integral",
                 plan.names[k].c_str());
            break;
        }
    if (constant > 0)
        warn("the draws of '%.40s' are all equal: no chain moved%s", plan.names[first_constant].c_str(),
             others(constant).c_str());
    if (disagree > 0)
        warn("the chains disagree: R-hat of '%.40s' is %.3f, expected at most 1.01%s",
             plan.names[most].c_str(), result.variables[most].r_hat, others(disagree).c_str());
    if (few > 0)
        warn("'%.40s' has only %.0f effective samples, expected %.0f%s", plan.names[fewest].c_str(),
             size(fewest), expected, others(few).c_str());
    if (plan.options.sampler == ChainSampler::ensemble && plan.domain.dimensions() > most_stretch_dimensions)
        warn("stretch moves may fail without a sign in more than %d variables; try slice",
             most_stretch_dimensions);
    if (result.non_finite > 0)
        warn("%llu of %llu log densities were not finite and were taken for -infinity",
             static_cast<unsigned long long>(result.non_finite),
             static_cast<unsigned long long>(result.evaluations));
}

} // namespace

int fewest_walkers(int dimensions) { return std::max(4, 2 * dimensions); }

int walkers_of(const ChainOptions& options, int dimensions) {
    if (options.sampler == ChainSampler::metropolis) return 1;
    return options.walkers == 0 ? std::max(8, 2 * (dimensions + 1)) : options.walkers;
}

std::optional<ChainSampler> chain_sampler(std::string_view name) {
    for (std::size_t i = 0; i < chain_sampler_names.size(); ++i)
        if (chain_sampler_names[i] == name) return static_cast<ChainSampler>(i);
    return std::nullopt;
}

ChainDraws sample_chains(const Integrand& log_density, const Domain& domain, const ChainOptions& options) {
    const ChainPlan plan = planned(log_density, domain, options);
    ChainDraws result;
    result.dimensions = domain.dimensions();
    result.chains = plan.chains() * plan.walkers;
    result.draws = options.draws;
    result.states.resize(result.chains * result.draws * plan.dimensions);
    if (options.sampler == ChainSampler::metropolis)
        run_walks(plan, result);
    else
        run_ensembles(plan, result);
    if (result.cancelled) {
        result.warnings.emplace_back("the chains were cancelled before their end");
        return result;
    }
    summarize_all(plan, result);
    add_warnings(plan, result);
    return result;
}

} // namespace montelux
