#include "bench/integrate/report.h"
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "montelux/mc/math/error.h"

namespace montelux::bench {

namespace {

const char* name_of(Kind kind) {
    return kind == Kind::sampling ? "sampling" : kind == Kind::cubature ? "cubature" : "either";
}

} // namespace

void write_json(const std::string& path, const Plan& plan, const std::vector<Run>& runs,
                const Summary& summary, std::span<const Overhead> overheads,
                std::span<const Scaling> scaling) {
    using nlohmann::json;
    json root;
    root["seeds"] = plan.seeds;
    for (const Method& method : plan.methods)
        root["methods"].push_back(
            {{"name", method.name}, {"kind", name_of(method.kind)}, {"ours", method.ours}});
    for (const Run& run : runs) {
        const Goal& goal = plan.goals[run.goal];
        json row = {{"line", line_name(plan.lines[run.line])},
                    {"method", plan.methods[run.method].name},
                    {"goal", goal.name()},
                    {"seed", run.seed},
                    {"evaluations", run.evaluations},
                    {"cpu_seconds", run.cpu_seconds},
                    {"exact", run.exact}};
        if (run.failure.empty()) {
            row["value"] = run.answer.value;
            row["claimed_relative_error"] = run.answer.error / std::abs(run.answer.value);
            row["true_relative_error"] = run.relative_error();
            row["converged"] = run.answer.converged;
            row["warned"] = run.answer.warned;
            if (!run.answer.chosen.empty()) row["chosen"] = run.answer.chosen;
        } else {
            row["failure"] = run.failure;
        }
        root["runs"].push_back(std::move(row));
    }
    for (std::size_t l = 0; l < plan.lines.size(); ++l)
        for (std::size_t m = 0; m < plan.methods.size(); ++m)
            for (std::size_t g = 0; g < plan.goals.size(); ++g) {
                const Cell& cell = summary.cell(l, m, g);
                json row = {{"line", line_name(plan.lines[l])},
                            {"method", plan.methods[m].name},
                            {"goal", plan.goals[g].name()},
                            {"runs", cell.runs},
                            {"failed", cell.failed},
                            {"warned", cell.warned},
                            {"median_cpu_seconds", cell.median_cpu_seconds},
                            {"rms_true_relative_error", cell.rms},
                            {"coverage", cell.coverage.within},
                            {"coverage_runs", cell.coverage.runs}};
                if (!plan.goals[g].spends()) {
                    row["answered"] = cell.answered;
                    row["silent_failures"] = cell.silent;
                    row["silent_failures_warnings_ignored"] = cell.silent_warnings_ignored;
                    row["honest"] = cell.honest;
                }
                row["median_evaluations"] = cell.median_evaluations ? json(*cell.median_evaluations) : json();
                root["cells"].push_back(std::move(row));
            }
    for (const Overhead& row : overheads)
        root["overheads"].push_back({{"method", row.method},
                                     {"form", row.form == Form::batch ? "batch" : "scalar"},
                                     {"nanoseconds", row.nanoseconds},
                                     {"evaluations", row.evaluations}});
    for (const Scaling& row : scaling)
        root["scaling"].push_back({{"method", row.method},
                                   {"nanoseconds_on_one_thread", row.nanoseconds_on_one},
                                   {"speedup_on_two_threads", row.speedup_on_two}});
    std::ofstream out(path);
    out << root.dump(1) << "\n";
    out.close();
    if (!out) throw Error(path, "the results could not be written");
}

} // namespace montelux::bench
