// montelux_bench_hard: integrators on the bank of hard integrals, judged by the truth of their errors.
#include "bench/hard/hard_options.h"
#include "bench/hard/hard_report.h"
#include "bench/hard/hard_runs_file.h"
#include "bench/hard/quick.h"
#include "bench/integrate/command_line.h"
#include "bench/integrate/montelux_methods.h"
#include "bench/integrate/rivals/rivals.h"
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iostream>

namespace {

using namespace montelux::bench;

montelux::CancelFlag interrupted;
void interrupt(int) { interrupted.request(); }

constexpr std::string_view ours = "montelux-";
constexpr std::string_view compared[] = {"auto",  "adaptive", "cubature",   "vegas",     "vegas_sobol",
                                         "quasi", "basic",    "stratified", "recursive", "vegas+"};

std::vector<Method> methods_of(const HardOptions& options) {
    std::vector<Method> all = montelux_methods(), chosen;
#ifdef MONTELUX_BENCH_VEGAS
    if (!options.vegas_python.empty()) {
        std::string message;
        for (Method& method : vegas_methods(options.vegas_python, message)) all.push_back(std::move(method));
        if (!message.empty()) std::cerr << "Without vegas+: " << message << "\n";
    }
#endif
    const std::vector<std::string> names =
        options.methods.empty() ? std::vector<std::string>(std::begin(compared), std::end(compared))
                                : options.methods;
    for (const std::string& name : names) {
        const auto found = std::find_if(all.begin(), all.end(), [&](const Method& method) {
            return method.name == name || method.name == std::string(ours) + name;
        });
        if (found != all.end())
            chosen.push_back(*found);
        else if (!options.methods.empty())
            throw montelux::Error("--methods", "there is no method '" + name + "' here; --list names them");
    }
    return chosen;
}

std::span<const HardFamily> bank_of(const HardOptions& options) {
    return options.bank == "judging" ? judging_families() : hard_families();
}

HardPlan plan_of(const HardOptions& options) {
    HardPlan plan;
    for (const HardFamily& family : bank_of(options))
        if (options.families.empty() || begins_with_one_of(options.families, family.name))
            plan.families.push_back(&family);
    if (plan.families.empty())
        throw montelux::Error("--families", "there is no such family; --list names them");
    plan.methods = methods_of(options);
    for (double target : options.targets)
        plan.goals.push_back({target, static_cast<std::uint64_t>(options.cap)});
    plan.first_seed = options.first_seed;
    plan.seeds = options.seeds;
    plan.seconds = options.seconds;
    plan.patience = 2 * options.seconds + 30;
    plan.jobs = options.jobs;
    return plan;
}

void list(const HardOptions& options) {
    for (const HardFamily& family : bank_of(options))
        std::cout << family.name << ": " << family.formula << "\n";
    HardOptions every = options;
    every.methods.clear();
    for (const Method& method : methods_of(every)) std::cout << "method " << method.name << "\n";
}

// Prints how many of the runs that converged have their truth within `errors` claimed errors. False if they
// are fewer than the share predicted by Student's law allows.
bool covers(std::string_view method, int within, int converged, double share, int errors) {
    const double n = converged;
    const double least = n * share - quick_deviations * std::sqrt(n * share * (1 - share));
    const bool enough = within >= least;
    std::cout << (enough ? "passed " : "FAILED ") << method << ": " << within << " of " << converged
              << " converged runs within " << errors << " claimed errors, at least "
              << static_cast<int>(std::ceil(least)) << " expected\n";
    return enough;
}

// The exit code: 1 where a method has more silent failures than it may, or errors that are too small.
int judge(const HardPlan& plan, const std::vector<HardRun>& runs) {
    int code = 0;
    for (const QuickLimit& limit : quick_limits) {
        const HardCell cell = hard_cell(runs, [&](const HardRun& run) {
            return plan.methods[run.run.method].name == std::string(ours) + std::string(limit.method);
        });
        const bool exceeded = cell.silent > limit.silent;
        std::cout << (exceeded ? "FAILED " : "passed ") << limit.method << ": " << cell.silent
                  << " silent failures in " << cell.runs << " runs, at most " << limit.silent << " allowed; "
                  << cell.honest << " converged honestly\n";
        if (exceeded) code = 1;
        if (!covers(limit.method, cell.within_one, cell.converged, quick_within_one, 1)) code = 1;
        if (!covers(limit.method, cell.within_two, cell.converged, quick_within_two, 2)) code = 1;
    }
    return code;
}

void report(const HardOptions& options, const HardPlan& plan, const std::vector<HardRun>& runs) {
    print_hard_report(std::cout, plan, runs);
    if (!options.json.empty()) write_hard_json(options.json, plan, runs);
    if (!options.verbose) return;
    std::cout << "\n## Silent failures\n\n";
    print_silent_failures(std::cout, plan, runs);
}

int run(const HardOptions& options) {
    if (options.list) return list(options), 0;
    if (!options.report.empty()) {
        const HardRecord record = read_hard_json(options.report);
        return report(options, record.plan, record.runs), 0;
    }
    const HardPlan plan = plan_of(options);
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
    std::size_t done = 0, silent = 0;
    const std::size_t total =
        plan.families.size() * plan.methods.size() * plan.goals.size() * static_cast<std::size_t>(plan.seeds);
    const std::vector<HardRun> runs = run_hard(
        plan,
        [&](const HardRun& run) {
            silent += run.silent();
            if (++done % 50 == 0 || done == total)
                std::fprintf(stderr, "%zu of %zu runs, %zu silent failures, now %s\n", done, total, silent,
                             std::string(plan.families[run.run.line]->name).c_str());
        },
        &interrupted);
    if (interrupted.requested()) std::cout << "Interrupted: what follows is of the runs made until then.\n\n";
    report(options, plan, runs);
    if (!options.quick) return 0;
    std::cout << "\n";
    return judge(plan, runs);
}

} // namespace

int main(int argc, char** argv) {
    try {
        const HardOptions options = parse_hard_options({argv + 1, argv + argc});
        if (options.help) {
            std::cout << hard_options_help();
            return 0;
        }
        return run(options);
    } catch (const std::exception& error) {
        std::cerr << "montelux_bench_hard: " << error.what() << "\n";
        return 1;
    }
}
