// montelux_bench_integrate: Montelux's integrators beside those of others, one thread each.
#include "bench/integrate/command_line.h"
#include "bench/integrate/montelux_methods.h"
#include "bench/integrate/options.h"
#include "bench/integrate/report.h"
#include "bench/integrate/rivals/rivals.h"
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace {

using namespace montelux::bench;

// An interrupted comparison, which may take hours, still reports what it has.
montelux::CancelFlag interrupted;
void interrupt(int) { interrupted.request(); }

std::vector<Method> all_methods(const Options& options) {
    std::vector<Method> methods = montelux_methods();
    auto add = [&](std::vector<Method> more) {
        for (Method& method : more) methods.push_back(std::move(method));
    };
    add(sobol_methods());
    std::string message;
    add(vegas_methods(options.vegas_python, message));
    if (!message.empty()) std::cerr << "Without vegas+: " << message << "\n";
#ifdef MONTELUX_BENCH_GSL
    add(gsl_methods());
#else
    std::cerr << "Without GSL: it was not found when this program was configured\n";
#endif
#ifdef MONTELUX_BENCH_CUBATURE
    add(cubature_methods());
#else
    std::cerr << "Without cubature: it was not found when this program was configured\n";
#endif
    return methods;
}

Plan plan_of(const Options& options, const std::vector<Method>& methods) {
    Plan plan;
    plan.seeds = options.seeds;
    for (Line line : bench_lines())
        if (options.lines.empty() || begins_with_one_of(options.lines, line_name(line)))
            plan.lines.push_back(line);
    for (const Method& method : methods)
        if (options.methods.empty() ? method.by_default : begins_with_one_of(options.methods, method.name))
            plan.methods.push_back(method);
    for (double target : options.targets)
        plan.goals.push_back({target, static_cast<std::uint64_t>(options.cap)});
    if (options.fixed > 0) plan.goals.push_back({0, static_cast<std::uint64_t>(options.fixed)});
    if (plan.lines.empty()) throw montelux::Error("--lines", "there is no such line; --list names them");
    if (plan.methods.empty())
        throw montelux::Error("--methods", "there is no such method; --list names them");
    return plan;
}

void show_progress(const Line& line, const Goal& goal, const Method& method, double cpu_seconds) {
    std::fprintf(stderr, "%-12s %-16s %-22s %8.2f s\n", line_name(line).c_str(), goal.name().c_str(),
                 method.name.c_str(), cpu_seconds);
}

template <typename F>
auto with_one_thread(const F& f) {
    const montelux::ThreadLimit one(1);
    return f();
}

int run(const Options& options) {
    const std::vector<Method> methods = all_methods(options);
    if (options.list) {
        for (Line line : bench_lines()) std::cout << "line " << line_name(line) << "\n";
        for (const Method& method : methods) std::cout << "method " << method.name << "\n";
        return 0;
    }
    const Plan plan = plan_of(options, methods);
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
    const std::vector<Run> runs = with_one_thread([&] { return run_all(plan, show_progress, &interrupted); });
    if (interrupted.requested()) std::cout << "Interrupted: what follows is of the runs made until then.\n\n";
    const Summary summary(plan, runs);
    std::cout << "# Integrators compared\n\nOne thread, " << plan.seeds << " seeds, at most "
              << static_cast<std::uint64_t>(options.cap)
              << " evaluations a run; pilots and reruns are counted.\n";
    print_report(std::cout, plan, runs, summary);
    std::vector<Overhead> overheads;
    std::vector<Scaling> scaling;
    if (options.overhead > 0 && !interrupted.requested()) {
        const auto evaluations = static_cast<std::uint64_t>(options.overhead);
        std::vector<Method> measured;
        for (const Method& method : plan.methods)
            if (method.name != "pcubature") measured.push_back(method); // exact after a few points
        overheads = with_one_thread([&] { return measure_overhead(measured, evaluations); });
        print_overheads(std::cout, overheads);
        scaling = measure_scaling(plan.methods, evaluations);
        print_scaling(std::cout, scaling);
    }
    if (!options.json.empty()) write_json(options.json, plan, runs, summary, overheads, scaling);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        const Options options = parse_options({argv + 1, argv + argc});
        if (options.help) {
            std::cout << options_help();
            return 0;
        }
        return run(options);
    } catch (const std::exception& error) {
        std::cerr << "montelux_bench_integrate: " << error.what() << "\n";
        return 1;
    }
}
