// montelux sample --log: Markov chains for a density that is known up to a constant, by its logarithm.
#include "app/commands.h"
#include "app/integrate/integrate_options.h"
#include "app/interrupt.h"
#include "app/sample/sample_options.h"
#include "app/usage_error.h"
#include "app/variables.h"
#include <cmath>
#include <cstdio>
#include <limits>

#include "montelux/mc/integrate/metropolis/metropolis_chain.h"
#include "montelux/mc/integrate/unit_points.h"

namespace montelux::app {
namespace {

constexpr int most_chains = 10000;
constexpr std::uint64_t most_numbers = std::uint64_t{1} << 32; // of all states
constexpr std::uint64_t start_draws = 1000;

double log_density_at(const Formulas& formula, const std::vector<Range>& ranges, std::span<const double> x) {
    for (std::size_t d = 0; d < x.size(); ++d)
        if (!(x[d] >= ranges[d].lower && x[d] <= ranges[d].upper))
            return -std::numeric_limits<double>::infinity();
    double y = 0;
    formula(PointBatch(x.data(), 1, static_cast<int>(x.size()), 1), ValueBatch(&y, 1, 1, 1));
    return y;
}

// A start for each chain: one of its own uniform points of the domain, drawn by the density, or what --start says.
std::vector<std::vector<double>> starts_of(const SampleOptions& o, const Formulas& formula,
                                           const Variables& variables, const NamedConstants& constants,
                                           int chains, std::uint64_t seed) {
    const std::size_t n = variables.names.size();
    std::vector<std::vector<double>> starts;
    for (const std::string& text : o.starts) {
        std::vector<double> start;
        for (std::size_t begin = 0; begin <= text.size();) {
            const std::size_t end = std::min(text.find(',', begin), text.size());
            start.push_back(constant(text.substr(begin, end - begin), "--start", constants));
            begin = end + 1;
        }
        if (start.size() != n)
            throw UsageError("--start", std::to_string(start.size()) + " numbers were given for " +
                                            std::to_string(n) + " variables");
        starts.push_back(std::move(start));
    }
    if (!starts.empty()) {
        if (starts.size() != 1 && starts.size() != static_cast<std::size_t>(chains))
            throw UsageError("--start", std::to_string(starts.size()) + " starts were given for " +
                                            std::to_string(chains) +
                                            " chains; expected one, or one for each");
        return starts;
    }
    const Domain domain(variables.ranges);
    for (int chain = 0; chain < chains; ++chain) {
        PointBuffer u(start_draws, static_cast<int>(n)), x(start_draws, static_cast<int>(n));
        fill_random(u, hash_key(seed, 0x7374617274), static_cast<std::uint32_t>(chain), 0);
        std::vector<double> volume(start_draws, 1.0);
        domain.map(u, x, volume);
        ValueBuffer y(start_draws, 1);
        formula(x, y);
        // In proportion to the density: the largest log p + Gumbel number.
        std::size_t best = start_draws;
        double largest = -std::numeric_limits<double>::infinity();
        PhiloxStream numbers(hash_key(seed, 0x67756d62656c), {static_cast<std::uint32_t>(chain), 0, 0});
        for (std::size_t i = 0; i < start_draws; ++i) {
            const double gumbel = -std::log(-std::log(numbers.next_double()));
            const double key = y(i) + std::log(volume[i]) + gumbel;
            if (key > largest && key < std::numeric_limits<double>::infinity()) {
                largest = key;
                best = i;
            }
        }
        if (best == start_draws)
            throw Error("sample", "the density is zero at all of " + std::to_string(start_draws) +
                                      " points; expected --start, where it is not");
        std::vector<double> start(n);
        x.view().gather(best, start.data());
        starts.push_back(std::move(start));
    }
    return starts;
}

void say_summary(const std::vector<std::string>& names, const MetropolisResult& r, int chains,
                 std::uint64_t samples) {
    std::fprintf(stderr, "montelux: %d chains of %llu states, %.0f %% accepted\n", chains,
                 static_cast<unsigned long long>(samples), 100 * r.acceptance_rate);
    for (std::size_t d = 0; d < names.size(); ++d) {
        const ChainSummary& s = r.observables[d];
        std::fprintf(stderr, "  %s: mean %s, deviation %.4g, R-hat %.4f, effective samples %.0f\n",
                     names[d].c_str(), to_string(Estimate{s.mean, s.standard_error}).c_str(),
                     std::sqrt(s.variance), s.r_hat, s.effective_sample_size);
    }
    for (const std::string& warning : r.warnings)
        std::fprintf(stderr, "montelux: warning: %s\n", warning.c_str());
}

} // namespace

int run_chains(const SampleOptions& o) {
    end_on_signals();
    if (o.formulas.size() != 1)
        throw UsageError("--log", "expected one formula, the logarithm of the density, for example -x^2/2");
    const NamedConstants constants = read_constants(o.let);
    const Variables variables = read_variables(o.over, true, constants);
    std::string text = o.formulas[0];
    if (text.starts_with(" -")) text.erase(0, 1); // the blank of with_negative_formulas
    const Formulas formula({text}, variables.names, "", constants);
    MetropolisOptions options;
    options.chains =
        o.chains.empty() ? 4 : static_cast<int>(whole_number(o.chains, "--chains", 1, most_chains));
    options.thin = o.thin.empty() ? 1 : whole_number(o.thin, "--thin", 1, 1'000'000'000);
    const std::uint64_t n = variables.names.size();
    const std::uint64_t kept =
        whole_number(o.n, "--n", 8, most_numbers / (static_cast<std::uint64_t>(options.chains) * n));
    options.samples = kept * options.thin;
    options.burn_in = o.burn_in.empty() ? 2000 : whole_number(o.burn_in, "--burn-in", 0, 1'000'000'000'000);
    options.seed = whole_number(o.seed, "--seed", 0, UINT64_MAX);
    options.cancel = &cancel_on_signals();
    const auto threads = static_cast<int>(whole_number(o.threads, "--threads", 0, most_threads));
    if (!o.output.empty()) check_output(o.output);
    const auto starts = starts_of(o, formula, variables, constants, options.chains, options.seed);

    std::vector<double> states(static_cast<std::uint64_t>(options.chains) * kept * n);
    const MetropolisResult result = with_threads(threads, [&] {
        return metropolis(
            [&](std::span<const double> x) { return log_density_at(formula, variables.ranges, x); },
            GaussianWalk{}, starts, static_cast<int>(n),
            [](std::span<const double> x, std::span<double> values) {
                std::copy(x.begin(), x.end(), values.begin());
            },
            [&](int chain, std::uint64_t k, std::span<const double> x) {
                std::copy(x.begin(), x.end(),
                          states.begin() + static_cast<std::ptrdiff_t>(
                                               (static_cast<std::uint64_t>(chain) * kept + k) * n));
            },
            options);
    });
    if (result.cancelled) return exit_interrupted;
    finish_on_signals();
    std::vector<std::string> names{"chain", "draw"};
    names.insert(names.end(), variables.names.begin(), variables.names.end());
    TableWriter table(o.output, format_of(o), names, static_cast<std::uint64_t>(options.chains) * kept);
    std::vector<double> row(names.size());
    for (std::uint64_t i = 0; i < states.size() / n; ++i) {
        row[0] = static_cast<double>(i / kept);
        row[1] = static_cast<double>(i % kept);
        std::copy_n(states.begin() + static_cast<std::ptrdiff_t>(i * n), n, row.begin() + 2);
        table.add(row);
    }
    table.finish();
    if (!o.quiet) say_summary(variables.names, result, options.chains, kept);
    return exit_done;
}

} // namespace montelux::app
