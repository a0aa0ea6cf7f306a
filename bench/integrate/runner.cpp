#include "bench/integrate/runner.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>

#include "montelux/mc/random/hash.h"

namespace montelux::bench {

double process_cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string Goal::name() const {
    char text[48];
    std::snprintf(text, sizeof text, "%.0e", spends() ? static_cast<double>(evaluations) : relative_error);
    std::string name = text;
    // 1e-03 as 1e-3, 1e+06 as 1e6.
    name.erase(std::remove(name.begin(), name.end(), '+'), name.end());
    const std::size_t zero = name.find_first_of("123456789", name.find('e') + 1);
    const std::size_t digits = name.find('-') == std::string::npos ? name.find('e') + 1 : name.find('-') + 1;
    if (zero != std::string::npos) name.erase(digits, zero - digits);
    return spends() ? name + " evaluations" : name;
}

Run run_one(const Method& method, const BenchProblem& problem, const Request& request) {
    Run run{};
    const CountedIntegrand counted(problem);
    const double begin = process_cpu_seconds();
    try {
        run.answer = method.run(counted, request);
    } catch (const std::exception& error) {
        run.failure = error.what();
    }
    run.cpu_seconds = run.answer.cpu_seconds.value_or(process_cpu_seconds() - begin);
    run.evaluations = run.answer.evaluations.value_or(counted.evaluations());
    run.exact = problem.exact();
    if (run.failure.empty() && !std::isfinite(run.answer.value)) run.failure = "the value is not finite";
    return run;
}

std::vector<Run> run_all(const Plan& plan, const Progress& progress, const CancelFlag* cancel) {
    std::vector<Run> runs;
    for (std::size_t l = 0; l < plan.lines.size(); ++l)
        for (std::size_t g = 0; g < plan.goals.size(); ++g)
            for (std::size_t m = 0; m < plan.methods.size(); ++m) {
                double cpu_seconds = 0;
                for (std::uint64_t seed = 0; seed < plan.seeds; ++seed) {
                    if (cancel && cancel->requested()) return runs;
                    const BenchIntegrand integrand(plan.lines[l], seed);
                    const Request request{.relative_error = plan.goals[g].relative_error,
                                          .evaluations = plan.goals[g].evaluations,
                                          .seed = hash_key(seed, g) >> 32,
                                          .form = plan.methods[m].forms.front()};
                    Run run = run_one(plan.methods[m], integrand, request);
                    run.line = l;
                    run.goal = g;
                    run.method = m;
                    run.seed = seed;
                    cpu_seconds += run.cpu_seconds;
                    runs.push_back(std::move(run));
                }
                progress(plan.lines[l], plan.goals[g], plan.methods[m], cpu_seconds);
            }
    return runs;
}

std::vector<Overhead> measure_overhead(const std::vector<Method>& methods, std::uint64_t evaluations) {
    const BenchIntegrand sum({Family::sum, 8}, 0);
    std::vector<Overhead> table;
    for (const Method& method : methods)
        for (Form form : method.forms) {
            Overhead row{method.name, form, std::numeric_limits<double>::infinity(), 0};
            for (std::uint64_t repeat = 0; repeat < 3; ++repeat) {
                const Run run = run_one(method, sum, {0, evaluations, repeat, form});
                if (!run.failure.empty() || run.evaluations == 0) continue;
                row.evaluations = run.evaluations;
                row.nanoseconds =
                    std::min(row.nanoseconds, 1e9 * run.cpu_seconds / static_cast<double>(run.evaluations));
            }
            table.push_back(row);
        }
    return table;
}

} // namespace montelux::bench
