// montelux sample: points of a set, or samples of a density.
#include "app/commands.h"
#include "app/integrate/integrate_options.h"
#include "app/joined.h"
#include "app/table_file.h"
#include "app/usage_error.h"
#include "app/variables.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "montelux/mc/math/nearest_name.h"
#include "montelux/mc/random/point_set.h"

namespace montelux::app {
namespace {

struct SampleOptions {
    std::string set, randomisation, n = "1024", dimensions, seed = "0", output, format;
    std::vector<std::string> over, densities;
};

// The names of an enumeration of consecutive values from 0 on.
template <typename Enum>
std::vector<std::string_view> names_up_to(Enum last) {
    std::vector<std::string_view> names;
    for (int i = 0; i <= static_cast<int>(last); ++i) names.push_back(to_string(static_cast<Enum>(i)));
    return names;
}
std::vector<std::string_view> set_names() { return names_up_to(PointSetKind::weyl); }
std::vector<std::string_view> randomisation_names() { return names_up_to(Randomisation::scramble); }

[[noreturn]] void refuse_name(const std::string& option, const std::string& given,
                              std::span<const std::string_view> names) {
    throw UsageError(option, "'" + given + "' is not known" + did_you_mean(given, names) +
                                 "; expected one of " + joined(names));
}

// By --format, else by the name of the file, else CSV.
TableFormat format_of(const SampleOptions& o) {
    if (!o.format.empty()) {
        const auto format = table_format(o.format);
        if (!format) refuse_name("--format", o.format, table_format_names);
        return *format;
    }
    const std::string extension = std::filesystem::path(o.output).extension().string();
    if (extension.empty()) return TableFormat::csv;
    const auto format = table_format(extension.substr(1));
    return format ? *format : TableFormat::csv;
}

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

// Points in [0, 1)^d, each coordinate moved by the quantile of its variable's density.
void run(const SampleOptions& o) {
    const TableFormat format = format_of(o);
    const bool by_density = !o.densities.empty() || !o.over.empty();
    if (!by_density && o.set.empty())
        throw UsageError("sample", "expected --set NAME, or --density FORMULA with --over NAME=LOWER:UPPER");
    Variables variables;
    if (by_density) {
        variables = read_variables(o.over, true);
        read_densities(o.densities, variables);
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

} // namespace

void add_sample(CLI::App& app, int& exit_code) {
    auto o = std::make_shared<SampleOptions>();
    CLI::App* c = app.add_subcommand("sample", "Write the points of a set, or samples of a density");
    auto text = [c](const std::string& name, std::string& target, const std::string& help,
                    const std::string& type) {
        c->add_option(name, target, help)->type_name(type)->take_last();
    };
    text("--set", o->set, "Which points of [0, 1)^d: " + joined(set_names()), "NAME");
    text("--n", o->n, "How many. Default: 1024", "N");
    text("--dim", o->dimensions, "Dimensions d. Default: 2", "D");
    text("--randomisation", o->randomisation,
         "How the set is randomised: " + joined(randomisation_names()) + ". Default: none", "NAME");
    text("--seed", o->seed, "Seed of independent points and of the randomisation. Default: 0", "N");
    c->add_option(
         "--density", o->densities,
         "Sample the density that is proportional to this formula, by inversion: FORMULA where there is "
         "one variable, else NAME=FORMULA for each; variables without one are uniform")
        ->type_name("FORMULA")
        ->allow_extra_args(false);
    c->add_option("--over", o->over, "A variable and its range, for example x=0:inf")
        ->type_name("NAME=LOWER:UPPER")
        ->allow_extra_args(false);
    text("-o,--output", o->output, "File to write. Default: standard output", "FILE");
    text("--format", o->format,
         "csv, npy (NumPy) or bin (little-endian doubles). Default: by the file's name, else csv", "NAME");
    c->footer(
        "Examples:\n"
        "  montelux sample --set sobol --n 1024 --dim 2 --randomisation scramble --seed 7 -o points.npy\n"
        "  montelux sample --density 'exp(-5*x)' --over x=0:inf --n 1000\n"
        "\n"
        "With a density, --set says which uniform numbers the quantiles get (default: independent).");
    c->callback([o, &exit_code] {
        run(*o);
        exit_code = exit_done;
    });
}

} // namespace montelux::app
