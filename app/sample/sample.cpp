// montelux sample: points of a set, samples of a density, of a trained density, or of Markov chains.
#include "app/commands.h"
#include "app/integrate/integrate_options.h"
#include "app/joined.h"
#include "app/sample/sample_options.h"
#include "app/table_file.h"
#include "app/usage_error.h"
#include "app/variables.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iterator>
#include <memory>

#include "montelux/mc/integrate/chains/sample_chains.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/mc/random/point_set.h"

namespace montelux::app {
namespace {

// The names of an enumeration of consecutive values from 0 on.
template <typename Enum>
std::vector<std::string_view> names_up_to(Enum last) {
    std::vector<std::string_view> names;
    for (int i = 0; i <= static_cast<int>(last); ++i) names.push_back(to_string(static_cast<Enum>(i)));
    return names;
}
std::vector<std::string_view> set_names() { return names_up_to(PointSetKind::weyl); }
std::vector<std::string_view> randomisation_names() { return names_up_to(Randomisation::scramble); }

constexpr std::string_view netcdf_name = "netcdf";

[[noreturn]] void refuse_name(const std::string& option, const std::string& given,
                              std::span<const std::string_view> names) {
    throw UsageError(option, "'" + given + "' is not known" + did_you_mean(given, names) +
                                 "; expected one of " + joined(names));
}

} // namespace

TableFormat format_of(const SampleOptions& o) {
    if (!o.format.empty()) {
        const auto format = table_format(o.format);
        if (!format) {
            std::vector<std::string_view> names(std::begin(table_format_names), std::end(table_format_names));
            names.push_back(netcdf_name);
            refuse_name("--format", o.format, names);
        }
        return *format;
    }
    const std::string extension = std::filesystem::path(o.output).extension().string();
    if (extension.empty()) return TableFormat::csv;
    const auto format = table_format(extension.substr(1));
    return format ? *format : TableFormat::csv;
}

bool is_netcdf(const SampleOptions& o) {
    if (!o.format.empty()) return o.format == netcdf_name;
    return std::filesystem::path(o.output).extension() == ".nc";
}

namespace {

PointSet make_point_set(const SampleOptions& o, bool by_density, std::size_t variables) {
    PointSet::Settings settings;
    const std::string set = o.set.empty() ? "independent" : o.set;
    const auto kind = point_set_kind(set);
    if (!kind) refuse_name("--set", set, set_names());
    settings.kind = *kind;
    settings.randomisation = Randomisation::none;
    if (!o.randomisation.empty()) {
        const auto chosen = randomisation(o.randomisation);
        if (!chosen) refuse_name("--randomisation", o.randomisation, randomisation_names());
        settings.randomisation = *chosen;
    }
    settings.seed = whole_number(o.seed, "--seed", 0, UINT64_MAX);
    settings.count = static_cast<std::uint32_t>(whole_number(o.n, "--n", 1, UINT32_MAX));
    if (by_density && !o.dimensions.empty())
        throw UsageError("--dim", "a density has the dimensions of its variables (--over)");
    settings.dimensions = by_density ? static_cast<int>(variables)
                          : o.dimensions.empty()
                              ? 2
                              : static_cast<int>(whole_number(o.dimensions, "--dim", 1, 1'000'000));
    try {
        return PointSet(settings);
    } catch (const Error& error) {
        throw UsageError("sample", error.what());
    }
}

// Options that belong to one kind of samples and were given with another.
void check_kind(const SampleOptions& o) {
    struct Rule {
        const char* option;
        bool given, allowed;
        const char* answer;
    };
    const bool trained = !o.from.empty(), points = !trained && !o.log;
    const Rule rules[] = {
        {"--log", o.log, !trained, "leave it out with --from, whose file knows it"},
        {"FORMULA", !o.formulas.empty(), o.log, "expected --log with a formula, or --density FORMULA"},
        {"--set", !o.set.empty(), points, "leave it out with --from and --log"},
        {"--randomisation", !o.randomisation.empty(), points, "leave it out with --from and --log"},
        {"--dim", !o.dimensions.empty(), points, "leave it out with --from and --log"},
        {"--density", !o.densities.empty(), points, "leave it out with --from and --log"},
        {"--let", !o.let.empty(), o.log || (!trained && !o.over.empty()),
         trained ? "leave it out with --from, whose file knows the constants" : "expected --over with it"},
        {"--over", !o.over.empty(), !trained, "leave it out with --from, whose file knows the variables"},
        {"--unweighted", o.unweighted, trained, "expected --from FILE with it"},
        {"--histogram", !o.histogram.empty(), trained, "expected --from FILE with it"},
        {"--covariance", o.covariance, trained, "expected --from FILE with it"},
        {"--pilot", !o.pilot.empty(), trained, "expected --from FILE with it"},
        {"--overweight-share", !o.overweight_share.empty(), trained, "expected --from FILE with it"},
        {"--max-draws", !o.max_draws.empty(), trained, "expected --from FILE with it"},
        {"--sampler", !o.sampler.empty(), o.log, "expected --log with it"},
        {"--chains", !o.chains.empty(), o.log, "expected --log with it"},
        {"--walkers", !o.walkers.empty(), o.log, "expected --log with it"},
        {"--burn-in", !o.burn_in.empty(), o.log, "expected --log with it"},
        {"--thin", !o.thin.empty(), o.log, "expected --log with it"},
        {"--start", !o.starts.empty(), o.log, "expected --log with it"},
        {"netCDF", is_netcdf(o), o.log,
         "such files hold chains; expected --log, or --format csv, npy or bin"},
    };
    for (const Rule& rule : rules)
        if (rule.given && !rule.allowed) throw UsageError(rule.option, rule.answer);
    if (!o.sampler.empty() && !chain_sampler(o.sampler))
        refuse_name("--sampler", o.sampler, chain_sampler_names);
}

// Points in [0, 1)^d, each coordinate moved by the quantile of its variable's density.
void write_points(const SampleOptions& o) {
    const TableFormat format = format_of(o);
    const bool by_density = !o.densities.empty() || !o.over.empty();
    if (!by_density && o.set.empty())
        throw UsageError("sample",
                         "expected --set NAME, or --density FORMULA with --over NAME=LOWER:UPPER, or "
                         "--from FILE, or FORMULA --log");
    Variables variables;
    if (by_density) {
        const NamedConstants constants = read_constants(o.let);
        variables = read_variables(o.over, true, constants);
        read_densities(o.densities, variables, constants);
        variables.densities.resize(variables.names.size());
        for (std::size_t d = 0; d < variables.names.size(); ++d) {
            const Range range = variables.ranges[d];
            if (variables.densities[d]) continue;
            if (!std::isfinite(range.upper - range.lower))
                throw UsageError("--over",
                                 "the range of '" + variables.names[d] +
                                     "' is infinite and has no uniform density; expected --density " +
                                     variables.names[d] + "=FORMULA");
            variables.densities[d] =
                Distribution::from_density([](double) { return 1.0; }, range.lower, range.upper);
        }
    }
    const PointSet points = make_point_set(o, by_density, variables.names.size());
    if (!o.output.empty()) check_output(o.output);
    const PointSet::Settings& settings = points.settings();
    std::vector<std::string> names = variables.names;
    for (int d = 0; !by_density && d < settings.dimensions; ++d) names.push_back("u" + std::to_string(d + 1));

    TableWriter table(o.output, format, names, settings.count);
    std::vector<double> row(names.size());
    for (std::uint32_t i = 0; i < settings.count; ++i) {
        for (int d = 0; d < settings.dimensions; ++d) {
            const double u = points(i, d);
            row[static_cast<std::size_t>(d)] =
                by_density ? variables.densities[static_cast<std::size_t>(d)]->sample(u) : u;
        }
        table.add(row);
    }
    table.finish();
}

int run(const SampleOptions& o) {
    check_kind(o);
    if (!o.from.empty()) return run_trained_samples(o);
    if (o.log) return run_chains(o);
    write_points(o);
    return exit_done;
}

} // namespace

void add_sample(CLI::App& app, int& exit_code) {
    auto o = std::make_shared<SampleOptions>();
    CLI::App* c = app.add_subcommand(
        "sample", "Write the points of a set, or samples: of a density, an integrand, Markov chains");
    c->add_option("FORMULA", o->formulas, "With --log: the logarithm of a density, for example -x^2/2");
    auto text = [c](const std::string& name, std::string& target, const std::string& help,
                    const std::string& type) {
        c->add_option(name, target, help)->type_name(type)->take_last();
    };
    text("--set", o->set, "Which points of [0, 1)^d: " + joined(set_names()), "NAME");
    text("--n", o->n, "How many; with --histogram draws, with --log of each chain. Default: 1024", "N");
    text("--dim", o->dimensions, "Dimensions d. Default: 2", "D");
    text("--randomisation", o->randomisation,
         "How the set is randomised: " + joined(randomisation_names()) + ". Default: none", "NAME");
    text("--seed", o->seed, "Seed of all random numbers. Default: 0", "N");
    c->add_option(
         "--density", o->densities,
         "Sample the density that is proportional to this formula, by inversion: FORMULA where there is "
         "one variable, else NAME=FORMULA for each; variables without one are uniform")
        ->type_name("FORMULA")
        ->allow_extra_args(false);
    c->add_option("--let", o->let, "A constant for formulas and ranges, for example s=0.1")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
    c->add_option("--over", o->over, "A variable and its range, for example x=0:inf")
        ->type_name("NAME=LOWER:UPPER")
        ->allow_extra_args(false);
    text("--from", o->from, "Sample the density that `montelux integrate --save-density` saved in this file",
         "FILE");
    c->add_flag("--unweighted", o->unweighted, "With --from: by rejection, so that nearly all weights are 1");
    text("--pilot", o->pilot, "With --unweighted: draws that decide the maximum weight. Default: 32768", "N");
    text("--overweight-share", o->overweight_share,
         "With --unweighted: share of the integral above the maximum weight. Default: 0.001", "SHARE");
    text("--max-draws", o->max_draws, "With --from: draws after which it ends with fewer samples", "N");
    text("--histogram", o->histogram,
         "With --from: the integral over each bin of an observable, with its error, for example "
         "'sqrt(s)=80:100:40'",
         "FORMULA=LOWER:UPPER:BINS");
    c->add_flag("--covariance", o->covariance, "With --histogram: the covariances, too");
    c->add_flag("--log", o->log,
                "Markov chains whose states follow the density of which FORMULA is the logarithm");
    text("--sampler", o->sampler,
         "With --log: " + joined(chain_sampler_names) +
             ". Random walks, or walkers that stretch or slice along one another's differences. Default: "
             "metropolis",
         "NAME");
    text("--chains", o->chains, "With --log: how many, or how many independent ensembles. Default: 4", "N");
    text("--walkers", o->walkers,
         "With --sampler ensemble or slice: of each ensemble. Default: 2 (variables + 1), at least 8", "N");
    text("--burn-in", o->burn_in, "With --log: states left out of each chain or walker. Default: 2000", "N");
    text("--thin", o->thin, "With --log: every how many-th state is written. Default: 1", "N");
    c->add_option("--start", o->starts, "With --log: where a chain starts; once for all, or once for each")
        ->type_name("X,Y,...")
        ->allow_extra_args(false);
    text("--threads", o->threads, "Threads; 0: one per processor. The result does not depend on it", "N");
    c->add_flag("--quiet", o->quiet, "Write the samples alone");
    text("-o,--output", o->output, "File to write. Default: standard output", "FILE");
    text("--format", o->format,
         "csv, npy (NumPy), bin (little-endian doubles) or, with --log, netcdf (ArviZ). Default: by the "
         "file's "
         "name, else csv",
         "NAME");
    c->footer(
        "Examples:\n"
        "  montelux sample --set sobol --n 1024 --dim 2 --randomisation scramble --seed 7 -o points.npy\n"
        "  montelux sample --density 'exp(-5*x)' --over x=0:inf --n 1000\n"
        "  montelux sample --from trained.mx --unweighted --n 1e5 -o events.npy\n"
        "  montelux sample -x^2-y^2+x*y --log --over x,y=-inf:inf --n 5000 -o chains.csv\n"
        "  montelux sample -x^2/2-8*(y-x^2)^2 --log --over x,y=-inf:inf --sampler slice --thin 10 -o "
        "banana.nc\n"
        "\n"
        "With a density, --set says which uniform numbers the quantiles get (default: independent).");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace montelux::app
