#include "app/integrate/integrate_options.h"

#include "app/integrate/compiled_function.h"
#include "app/interrupt.h"
#include "app/joined.h"
#include "app/option_values.h"
#include "app/usage_error.h"
#include "app/variables.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/device/formula_source.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::app {
namespace {

constexpr std::array<std::string_view, 4> domain_names{"box", "simplex", "ball", "sphere"};
constexpr std::array<std::string_view, 2> policy_names{"skip", "throw"};
constexpr std::array<std::string_view, 2> norm_names{"component", "vector"};

void check_choice(const std::string& given, std::span<const std::string_view> names,
                  const std::string& option, const std::string& what) {
    if (std::find(names.begin(), names.end(), given) == names.end())
        throw UsageError(option, "there is no " + what + " '" + given + "'" + did_you_mean(given, names) +
                                     "; expected one of " + joined(names));
}

// A finite number above zero; 0 where nothing was given.
double positive(const std::string& text, const std::string& option, const std::string& hint) {
    if (text.empty()) return 0;
    const double value = constant(text, option);
    if (!(value > 0 && std::isfinite(value)))
        throw UsageError(option, "'" + text + "' was given; expected a finite number above 0" + hint);
    return value;
}

// A relative error: also 1%.
double relative_error(const std::string& text) {
    const bool percent = text.ends_with('%');
    const std::string hint = "; leave it out to stop at --evaluations or --time";
    return positive(percent ? text.substr(0, text.size() - 1) : text, "--relative-error", hint) *
           (percent ? 0.01 : 1);
}

// Seconds as a formula, or with units: 90s, 10m, 1h30m.
double seconds(const std::string& text) {
    const bool units = text.find_first_not_of("0123456789.hms") == std::string::npos &&
                       text.find_first_of("hms") != std::string::npos;
    return units ? parse_time_limit("--time", text) : positive(text, "--time", " of seconds");
}

std::vector<double> read_centre(const std::string& text, std::size_t dimensions) {
    if (text.empty()) return std::vector<double>(dimensions);
    std::vector<double> centre;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        centre.push_back(constant(text.substr(begin, end - begin), "--centre"));
        begin = end + 1;
    }
    if (centre.size() != dimensions)
        throw UsageError("--centre", std::to_string(centre.size()) + " coordinates were given for " +
                                         std::to_string(dimensions) + " variables");
    return centre;
}

Domain make_domain(const IntegrateOptions& o, const Variables& variables) {
    const std::size_t n = variables.names.size();
    const bool round = o.domain == "ball" || o.domain == "sphere";
    for (const auto& [option, value] : {std::pair("--radius", &o.radius), std::pair("--centre", &o.centre)})
        if (!round && !value->empty())
            throw UsageError(option, "a " + o.domain + " has none; expected --domain ball or sphere with it");
    if (o.domain == "box") return box_domain(variables);
    try {
        if (o.domain == "simplex") return Domain::simplex(static_cast<int>(n));
        const double radius = o.radius.empty() ? 1 : positive(o.radius, "--radius", "");
        std::vector<double> centre = read_centre(o.centre, n);
        return o.domain == "ball" ? Domain::ball(std::move(centre), radius)
                                  : Domain::sphere(std::move(centre), radius);
    } catch (const UsageError&) {
        throw;
    } catch (const Error& error) {
        throw UsageError("--domain " + o.domain, error.what());
    }
}

Method make_method(const std::string& name) {
    if (name.empty()) return {};
    check_choice(name, Method::names(), "--method", "method");
    return Method::named(name);
}

void check_logarithm(const IntegrateOptions& o) {
    if (o.formulas.size() > 1)
        throw UsageError("--log", std::to_string(o.formulas.size()) + " formulas were given; expected one");
    if (!o.components.empty()) throw UsageError("--log", "log f has one value; leave out --components");
    if (!o.absolute_error.empty())
        throw UsageError("--absolute-error",
                         "with --log, expected --relative-error, which is the error of log Z");
    if (!o.plot.empty()) throw UsageError("--plot", "log Z is not drawn; leave out one of --log and --plot");
}

// One integrand.
void check_sources(const IntegrateOptions& o) {
    const int given = int(!o.formulas.empty()) + int(!o.library.empty()) + int(!o.source.empty());
    if (given != 1)
        throw UsageError("integrand", std::string(given == 0 ? "none" : "more than one") +
                                          " is given; expected a FORMULA, --library or --source");
    if (!o.components.empty() && !o.formulas.empty())
        throw UsageError("--components", "each component of a vector is a FORMULA of its own");
}

NamedIntegrand on_device(const std::string& device, const FunctionSource& source,
                         const std::vector<std::string>& variables, std::vector<std::string> names) {
    const WaitingSignals until_compiled; // the emulation makes temporary files
    auto compiled = std::make_shared<const DeviceFunction>(Device::open(device), source,
                                                           static_cast<int>(variables.size()));
    const Integrand f = Integrand::compiled(compiled);
    return {[f](const PointBatch& x, ValueBatch y) { f(x, y); }, std::move(names), std::move(compiled)};
}

NamedIntegrand make_integrand(const IntegrateOptions& o, const std::vector<std::string>& variables,
                              const NamedConstants& constants) {
    if (o.formulas.empty()) {
        CompiledFunction::Form form;
        if (!o.components.empty())
            form.components = static_cast<int>(whole_number(o.components, "--components", 1, 100'000));
        for (const NamedConstant& c : constants) form.parameters.push_back(c.value);
        if (!o.device.empty()) {
            if (!o.library.empty())
                throw UsageError("--library",
                                 "a device compiles sources and does not call libraries; expected a "
                                 "FORMULA or --source with --device");
            if (!o.save_density.empty() && CompiledFunction::is_cuda(o.source))
                throw UsageError(
                    "--save-density",
                    "'" + CompiledFunction::file_of(o.source) +
                        "' is a CUDA source, which `montelux sample` cannot call; expected a FORMULA, "
                        "or a source in C or C++");
            const FunctionSource source = CompiledFunction::read_source(o.source, form);
            return on_device(o.device, source, variables,
                             CompiledFunction::names(source.function, source.components));
        }
        const CompiledFunction function = o.library.empty() ? CompiledFunction::from_source(o.source, form)
                                                            : CompiledFunction::from_library(o.library, form);
        return {function, function.names()};
    }
    std::vector<std::string> formulas = o.formulas;
    for (std::string& text : formulas)
        if (text.starts_with(" -")) text.erase(0, 1); // the blank of with_negative_formulas
    Formulas parsed(formulas, variables, "", constants);
    std::vector<std::vector<double>> landmarks = parsed.landmarks();
    std::vector<Integrand::BatchFunction> guides = parsed.guides();
    Integrand::BatchFunction rounding = parsed.rounding();
    std::vector<std::pair<std::string, double>> numbers;
    for (const NamedConstant& c : constants) numbers.emplace_back(c.name, c.value);
    NamedIntegrand made = o.device.empty() ? NamedIntegrand{std::move(parsed), formulas}
                                           : on_device(o.device, formula_source(formulas, variables, numbers),
                                                       variables, formulas);
    made.landmarks = std::move(landmarks);
    made.guides = std::move(guides);
    made.rounding = std::move(rounding);
    return made;
}

// 10k, 1.5M and 2G as 10e3, 1.5e6 and 2e9; other texts as they are.
std::string with_exponent(const std::string& text) {
    constexpr std::string_view units = "kMG", exponents = "369";
    const std::size_t unit = text.empty() ? std::string_view::npos : units.find(text.back());
    if (unit == std::string_view::npos || text.size() < 2) return text;
    const std::string digits = text.substr(0, text.size() - 1);
    if (digits.find_first_not_of("0123456789.") != std::string::npos) return text;
    return digits + "e" + exponents[unit];
}

} // namespace

std::vector<std::string> with_negative_formulas(const CLI::App& command, std::vector<std::string> words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        std::string& word = words[i];
        if (word == "--") break; // whatever follows is a formula
        const CLI::Option* const option = command.get_option_no_throw(word);
        if (option != nullptr) {
            i += static_cast<std::size_t>(option->get_expected_min());
        } else if (word.size() > 1 && word[0] == '-' && word[1] != '-') {
            word.insert(0, 1, ' ');
        }
    }
    return words;
}

std::uint64_t whole_number(const std::string& text, const std::string& option, std::uint64_t lowest,
                           std::uint64_t highest) {
    // Digits alone are read exactly; doubles hold whole numbers up to 2^53.
    std::uint64_t exact = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, exact);
    bool good = error == std::errc() && stop == end && !text.empty();
    if (!good) {
        const double value = constant(with_exponent(text), option);
        good = value >= 0 && value <= 0x1p53 && value == std::floor(value);
        if (good) exact = static_cast<std::uint64_t>(value);
    }
    if (good && exact >= lowest && exact <= highest) return exact;
    const std::string range = highest == UINT64_MAX
                                  ? (lowest > 0 ? " from " + std::to_string(lowest) : std::string())
                                  : " from " + std::to_string(lowest) + " to " + std::to_string(highest);
    throw UsageError(option, "'" + text + "' was given; expected a whole number" + range);
}

void declare(CLI::App& c, IntegrateOptions& o) {
    c.add_option("FORMULA", o.formulas,
                 "The integrand, for example 'sin(x)*y'; several are the components of a vector");
    auto many = [&c](const std::string& name, std::vector<std::string>& target, const std::string& help,
                     const std::string& type) {
        c.add_option(name, target, help)->type_name(type)->allow_extra_args(false);
    };
    auto text = [&c](const std::string& name, std::string& target, const std::string& help,
                     const std::string& type) {
        return c.add_option(name, target, help)->type_name(type)->take_last();
    };
    many("--over", o.over, "A variable and its range, for example x=0:inf, x,y=-1:1 or x1..x8=0:1",
         "NAME=LOWER:UPPER");
    many("--let", o.let, "A constant for formulas and ranges, for example s=0.1", "NAME=VALUE");
    text("--library", o.library,
         "In place of formulas: a function of a shared library, for example ./f.so:name, declared as double "
         "name(int n, const double *x)",
         "FILE:FUNCTION");
    text("--source", o.source, "The same from a file in C or C++, which the system's compiler translates",
         "FILE:FUNCTION");
    text("--components", o.components,
         "The function has this many values: void name(int n, const double *x, int m, double *y)", "M");
    c.add_flag("--log", o.log,
               "The integrand is log f, the natural logarithm of the integrand; print log Z, that of the "
               "integral, for "
               "values such as e^-5000");
    many("--density", o.densities,
         "Draw a variable from a density that is proportional to this formula, for example x=exp(-5*x)",
         "NAME=FORMULA");
    text("--method", o.method, "How: " + joined(Method::names()) + ". Default: " + Method().name(), "NAME");
    text(
        "--device", o.device,
        "Draw and evaluate the points on a device: cuda, a GPU, or emulated, to check its code. For formulas "
        "and --source (C or CUDA C++), and the method " +
            Method::device_names(),
        "NAME");
    text("--relative-error", o.relative_error,
         "Stop at this standard error relative to the value, for example 1e-3 or 0.1%", "E");
    text("--absolute-error", o.absolute_error, "Stop at this standard error; with both, at the larger one",
         "E");
    text("--norm", o.norm,
         "What the relative error of several formulas refers to: the value of each component, or vector, "
         "the norm of all. Default: component",
         "NAME");
    text("--evaluations", o.evaluations,
         "Maximum number of evaluations, for example 50000, 50k, 1M or 1e6. Default: 1e6 without an error "
         "or a time",
         "N");
    text("--time", o.time,
         "Stop after this time, for example 90, 90s, 10m or 1h30m. Default with an error and without "
         "evaluations: 60 s, or 1e9 evaluations",
         "TIME");
    text("--seed", o.seed, "Seed of all random numbers. Default: 0", "N");
    text("--threads", o.threads, "Threads; 0: one per processor. The result does not depend on it", "N");
    text("--domain", o.domain,
         "Where: " + joined(domain_names) + "; all but the box take --over NAMES. Default: box", "NAME");
    text("--radius", o.radius, "Radius of ball and sphere. Default: 1", "R");
    text("--centre", o.centre, "Centre of ball and sphere. Default: the origin", "X,Y,...");
    text("--non-finite", o.non_finite,
         "Values that are not finite numbers: skip counts and reports them, throw ends with an error",
         "POLICY");
    text("--checkpoint", o.checkpoint, "Keep the running state in this file", "FILE")->check(file_name());
    text("--checkpoint-every", o.checkpoint_every, "How often it is written. Default: 60", "SECONDS");
    c.add_flag("--resume", o.resume, "Resume from the checkpoint, if it exists");
    text("--plot", o.plot, "Draw value and error against the evaluations (.svg)", "FILE");
    text("--points", o.points, "Write the points and values of the integrand (.csv); uses one thread",
         "FILE");
    text("--points-limit", o.points_limit, "Number of points written, from the first on. Default: 10000",
         "N");
    text("--save-density", o.save_density,
         "Save the density that adaptive, vegas or vegas_sobol trained, for `montelux sample --from`", "FILE")
        ->check(file_name());
    c.add_flag("--json", o.json, "Print JSON");
    c.add_flag("--quiet", o.quiet, "Show no progress");
    c.footer(
        "Examples:\n"
        "  montelux integrate 'sin(x)*y' --over x=0:pi/2 --over y=0:1 --relative-error 1e-4\n"
        "  montelux integrate 'exp(-5*x)*cos(x)' --over x=0:inf --density x='exp(-5*x)' --evaluations 1e5\n"
        "  montelux integrate 1 x^2 --domain ball --over x,y,z --json\n"
        "  montelux integrate --log -5000-x^2/2 --over x=-inf:inf --relative-error 1e-6\n"
        "  montelux integrate --source integrand.c --let s=0.1 --over x1..x6=0:1\n"
        "\n"
        "Formulas know + - * / ^, comparisons, && ||, c ? a : b, pi, e, inf, and\n"
        "  " +
        formula_functions() +
        ".\n"
        "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 stopped before the target error, or reached it with "
        "a\n"
        "warning (the result is printed), 130 interrupted (the result so far is printed).");
}

IntegrationTask make_task(const IntegrateOptions& o) {
    check_choice(o.domain, domain_names, "--domain", "domain");
    check_choice(o.non_finite, policy_names, "--non-finite", "policy");
    check_choice(o.norm, norm_names, "--norm", "norm");
    if (!o.device.empty()) check_choice(o.device, Device::names(), "--device", "device");
    const bool box = o.domain == "box";
    check_sources(o);
    const NamedConstants constants = read_constants(o.let);
    Variables variables = read_variables(o.over, box, constants);
    if (!box && !o.densities.empty()) throw UsageError("--density", "only a box takes densities");
    if (o.log) check_logarithm(o);
    Method method = make_method(o.method);
    if (!o.device.empty() && !method.on_device())
        throw UsageError("--method", "the method '" + method.name() + "' does not run on a device" +
                                         (o.method.empty() ? ", and is the default" : "") + "; expected " +
                                         Method::device_names());
    NamedIntegrand integrand = make_integrand(o, variables.names, constants);

    Budget budget;
    budget.relative_error = relative_error(o.relative_error);
    budget.absolute_error =
        positive(o.absolute_error, "--absolute-error", "; leave it out to stop at --evaluations or --time");
    budget.time = std::chrono::duration<double>(seconds(o.time));
    if (o.norm == "vector") budget.norm = ErrorNorm::vector;
    if (!o.evaluations.empty())
        budget.evaluations = whole_number(o.evaluations, "--evaluations", 1, UINT64_MAX);

    IntegrationOptions options;
    options.seed = whole_number(o.seed, "--seed", 0, UINT64_MAX);
    options.threads = static_cast<int>(whole_number(o.threads, "--threads", 0, most_threads));
    options.non_finite = o.non_finite == "skip" ? NonFinitePolicy::skip : NonFinitePolicy::throw_error;
    options.checkpoint = o.checkpoint;
    if (!o.checkpoint_every.empty() && o.checkpoint.empty())
        throw UsageError("--checkpoint-every", "expected --checkpoint FILE, which says what to write");
    const double every = o.checkpoint_every.empty() ? 60 : constant(o.checkpoint_every, "--checkpoint-every");
    if (!(every >= 0 && every < 1e9))
        throw UsageError("--checkpoint-every", "'" + o.checkpoint_every + "' was given; expected seconds");
    options.checkpoint_every = std::chrono::duration<double>(every);
    options.resume = o.resume;
    if (o.resume && o.checkpoint.empty())
        throw UsageError("--resume", "expected --checkpoint FILE to resume from");
    if (!o.points.empty()) {
        if (!o.device.empty())
            throw UsageError("--points",
                             "the points of a device stay there; leave out one of --points and --device");
        if (options.threads > 1)
            throw UsageError("--points", "the points are written in their order, by one thread; leave out "
                                         "--threads");
        if (!o.checkpoint.empty())
            throw UsageError("--points", "a run with a checkpoint may be a part of one; leave out one of "
                                         "--points and --checkpoint");
        options.threads = 1;
    }
    const std::uint64_t points_limit = whole_number(o.points_limit, "--points-limit", 1, 100'000'000);

    read_densities(o.densities, variables, constants);
    check_densities(variables, integrand, o.log);
    Domain domain = make_domain(o, variables).named(variables.names);
    return {variables.names,    constants,         std::move(integrand),
            std::move(domain),  std::move(method), budget,
            std::move(options), points_limit,      o.log};
}

} // namespace montelux::app
