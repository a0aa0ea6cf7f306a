// montelux sample --log: Markov chains for a density that is known up to a constant, by its logarithm.
#include "app/commands.h"
#include "app/integrate/integrate_options.h"
#include "app/interrupt.h"
#include "app/sample/netcdf_file.h"
#include "app/sample/sample_options.h"
#include "app/usage_error.h"
#include "app/variables.h"
#include <cstdio>

#include "montelux/mc/integrate/chains/sample_chains.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/estimate.h"

namespace montelux::app {
namespace {

constexpr int most_chains = 10000, most_walkers = 100000;
constexpr std::uint64_t fewest_draws = 8;                      // of a chain
constexpr std::uint64_t most_numbers = std::uint64_t{1} << 32; // of all states

std::vector<std::vector<double>> read_starts(const SampleOptions& o, const NamedConstants& constants,
                                             std::size_t variables) {
    std::vector<std::vector<double>> starts;
    for (const std::string& text : o.starts) {
        std::vector<double> start;
        for (std::size_t begin = 0; begin <= text.size();) {
            const std::size_t end = std::min(text.find(',', begin), text.size());
            start.push_back(constant(text.substr(begin, end - begin), "--start", constants));
            begin = end + 1;
        }
        if (start.size() != variables)
            throw UsageError("--start", std::to_string(start.size()) + " numbers were given for " +
                                            std::to_string(variables) + " variables");
        starts.push_back(std::move(start));
    }
    return starts;
}

ChainOptions read_options(const SampleOptions& o, const NamedConstants& constants,
                          const std::vector<std::string>& names) {
    ChainOptions options;
    const auto n = static_cast<int>(names.size());
    if (!o.sampler.empty()) options.sampler = *chain_sampler(o.sampler);
    if (!o.chains.empty())
        options.chains = static_cast<int>(whole_number(o.chains, "--chains", 1, most_chains));
    if (!o.walkers.empty()) {
        if (options.sampler == ChainSampler::metropolis)
            throw UsageError("--walkers",
                             "chains of metropolis have none; expected --sampler ensemble or slice");
        options.walkers = static_cast<int>(whole_number(o.walkers, "--walkers", 1, most_walkers));
        if (options.walkers < fewest_walkers(n))
            throw UsageError("--walkers", o.walkers + " are too few for " + std::to_string(n) +
                                              (n == 1 ? " variable" : " variables") + "; expected at least " +
                                              std::to_string(fewest_walkers(n)));
    }
    if (!o.thin.empty()) options.thin = whole_number(o.thin, "--thin", 1, 1'000'000'000);
    const auto sequences =
        static_cast<std::uint64_t>(options.chains) * static_cast<std::uint64_t>(walkers_of(options, n));
    const std::uint64_t most_draws = most_numbers / (sequences * names.size());
    if (most_draws < fewest_draws)
        throw UsageError(o.walkers.empty() ? "--chains" : "--walkers",
                         std::to_string(sequences) + " chains or walkers in all are too many for " +
                             std::to_string(n) + (n == 1 ? " variable" : " variables") +
                             "; expected at most " +
                             std::to_string(most_numbers / (fewest_draws * names.size())));
    options.draws = whole_number(o.n, "--n", fewest_draws, most_draws);
    if (!o.burn_in.empty()) options.burn_in = whole_number(o.burn_in, "--burn-in", 0, 1'000'000'000'000);
    options.seed = whole_number(o.seed, "--seed", 0, UINT64_MAX);
    options.starts = read_starts(o, constants, names.size());
    const std::size_t starts = options.starts.size();
    if (starts > 1 && starts != static_cast<std::size_t>(options.chains) && starts != sequences)
        throw UsageError("--start", std::to_string(starts) + " starts were given for " +
                                        std::to_string(options.chains) +
                                        " chains; expected one, or one for each");
    options.names = names;
    options.cancel = &cancel_on_signals();
    return options;
}

// Tables and netCDF files have columns, or dimensions, of these names already.
void check_names(const std::vector<std::string>& names) {
    for (const std::string& name : names)
        if (name == "chain" || name == "draw")
            throw UsageError("--over",
                             "the variable '" + name +
                                 "' has the name of a column of what is written; expected another one");
}

void say_summary(const std::vector<std::string>& names, const ChainDraws& r, const ChainOptions& options) {
    const auto draws = static_cast<unsigned long long>(r.draws);
    const char* const plural = options.chains == 1 ? "" : "s";
    const double states = static_cast<double>((r.draws * options.thin + options.burn_in) * r.chains);
    if (options.sampler == ChainSampler::metropolis)
        std::fprintf(stderr, "montelux: %d chain%s of %llu draws", options.chains, plural, draws);
    else
        std::fprintf(stderr, "montelux: %d ensemble%s of %d walkers, %llu draws each", options.chains, plural,
                     static_cast<int>(r.chains) / options.chains, draws);
    if (options.sampler == ChainSampler::slice)
        std::fprintf(stderr, ", %.1f evaluations per state\n", static_cast<double>(r.evaluations) / states);
    else
        std::fprintf(stderr, ", %.0f %% accepted\n", 100 * r.acceptance_rate);
    for (std::size_t d = 0; d < names.size(); ++d) {
        const DrawSummary& s = r.variables[d];
        std::fprintf(
            stderr, "  %s: mean %s, deviation %.4g, R-hat %.4f, effective samples %.0f (bulk), %.0f (tail)\n",
            names[d].c_str(), to_string(Estimate{s.mean, s.standard_error}).c_str(), s.standard_deviation,
            s.r_hat, s.bulk_effective_size, s.tail_effective_size);
    }
    for (const std::string& warning : r.warnings)
        std::fprintf(stderr, "montelux: warning: %s\n", warning.c_str());
}

void write_table(const SampleOptions& o, const std::vector<std::string>& variables, const ChainDraws& draws) {
    std::vector<std::string> names{"chain", "draw"};
    names.insert(names.end(), variables.begin(), variables.end());
    TableWriter table(o.output, format_of(o), names, draws.chains * draws.draws);
    std::vector<double> row(names.size());
    const std::size_t n = variables.size();
    for (std::uint64_t i = 0; i < draws.chains * draws.draws; ++i) {
        row[0] = static_cast<double>(i / draws.draws);
        row[1] = static_cast<double>(i % draws.draws);
        std::copy_n(draws.states.begin() + static_cast<std::ptrdiff_t>(i * n), n, row.begin() + 2);
        table.add(row);
    }
    table.finish();
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
    const ChainOptions options = read_options(o, constants, variables.names);
    const auto threads = static_cast<int>(whole_number(o.threads, "--threads", 0, most_threads));
    const bool netcdf = is_netcdf(o);
    check_names(variables.names);
    if (netcdf) check_netcdf();
    if (!o.output.empty()) check_output(o.output);
    const ChainDraws draws = with_threads(threads, [&] {
        return sample_chains(Integrand::batch([&](const PointBatch& x, ValueBatch y) { formula(x, y); }),
                             variables.ranges, options);
    });
    if (draws.cancelled) {
        if (!o.quiet) std::fprintf(stderr, "montelux: interrupted; no draws were written\n");
        return exit_interrupted;
    }
    finish_on_signals();
    if (netcdf)
        write_netcdf(o.output, variables.names, draws);
    else
        write_table(o, variables.names, draws);
    if (!o.quiet) say_summary(variables.names, draws, options);
    return exit_done;
}

} // namespace montelux::app
