#include "bench/hard/hard_report.h"

#include "bench/integrate/markdown.h"
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "montelux/mc/math/special.h"

namespace montelux::bench {

void HardCell::add(const HardRun& run) {
    ++runs;
    silent += run.silent();
    silent_at_cap += run.silent_at_cap();
    honest += run.honest();
    warned += run.run.failure.empty() && run.run.answer.warned;
    failed += !run.run.failure.empty();
    if (!run.converged()) return;
    ++converged;
    within_one += run.within(1);
    within_two += run.within(2);
    evaluations.push_back(static_cast<double>(run.run.evaluations));
}

std::optional<double> HardCell::median_evaluations() const {
    if (evaluations.empty()) return std::nullopt;
    std::vector<double> sorted = evaluations;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
}

namespace {

std::string percent(double share) { return formatted("%.1f %%", 100 * share); }
std::string share_of(int part, int whole) {
    return whole > 0 ? percent(static_cast<double>(part) / whole) : "-";
}
// 0.8 % (3)
std::string counted_share(int part, int whole) {
    return share_of(part, whole) + " (" + std::to_string(part) + ")";
}
std::string count_or_none(std::optional<double> n) { return n ? short_count(*n) : "-"; }

// Degrees of freedom of the claimed error: replicates or iterations less one.
struct Freedom {
    std::string_view method, note;
    double degrees; // 0: not one number
};
constexpr Freedom freedoms[] = {
    {"adaptive", "16 replicates", 15},
    {"quasi", "16 replicates", 15},
    {"vegas_sobol", "16 replicates", 15},
    {"vegas+", "10 iterations, each with its variance", 0},
    {"vegas", "variances within the strata", 0},
    {"basic", "all points", 0},
    {"stratified", "variances within the strata", 0},
    {"recursive", "variances within the strata", 0},
    {"cubature", "a difference of rules: a bound, not a deviation", 0},
};

std::string plain_name(const std::string& method) {
    constexpr std::string_view prefix = "montelux-";
    return method.starts_with(prefix) ? method.substr(prefix.size()) : method;
}

void print_methods(std::ostream& out, const HardPlan& plan, const std::vector<HardRun>& runs) {
    std::vector<std::string> header = {
        "method", "runs", "silent", "worst family", "there", "silent at the cap", "with warning", "no value"};
    for (const Goal& goal : plan.goals) header.push_back("honest at " + goal.name());
    MarkdownTable table(header);
    for (std::size_t m = 0; m < plan.methods.size(); ++m) {
        const HardCell all = hard_cell(runs, [&](const HardRun& r) { return r.run.method == m; });
        if (all.runs == 0) continue;
        std::size_t worst = 0;
        double worst_share = -1;
        for (std::size_t f = 0; f < plan.families.size(); ++f) {
            const double share = hard_cell(runs, [&](const HardRun& r) {
                                     return r.run.method == m && r.run.line == f;
                                 }).silent_share();
            if (share > worst_share) worst_share = share, worst = f;
        }
        std::vector<std::string> row = {plain_name(plan.methods[m].name),
                                        std::to_string(all.runs),
                                        counted_share(all.silent, all.runs),
                                        worst_share > 0 ? std::string(plan.families[worst]->name) : "-",
                                        percent(worst_share),
                                        share_of(all.silent_at_cap, all.runs),
                                        share_of(all.warned, all.runs),
                                        share_of(all.failed, all.runs)};
        for (std::size_t g = 0; g < plan.goals.size(); ++g)
            row.push_back(percent(hard_cell(runs, [&](const HardRun& r) {
                                      return r.run.method == m && r.run.goal == g;
                                  }).honest_share()));
        table.add(row);
    }
    out << "\n## Methods\n\n" << table;
}

void print_families(std::ostream& out, const HardPlan& plan, const std::vector<HardRun>& runs,
                    std::size_t method) {
    // Honest convergence and evaluations at 1e-3, or at the goal nearest to it.
    std::size_t goal = 0;
    for (std::size_t g = 0; g < plan.goals.size(); ++g)
        if (std::abs(std::log(plan.goals[g].relative_error / 1e-3)) <
            std::abs(std::log(plan.goals[goal].relative_error / 1e-3)))
            goal = g;
    const std::string at = " at " + plan.goals[goal].name();
    std::vector<HardCell> all, here;
    for (std::size_t f = 0; f < plan.families.size(); ++f) {
        auto of = [&](const HardRun& r) { return r.run.method == method && r.run.line == f; };
        all.push_back(hard_cell(runs, of));
        here.push_back(hard_cell(runs, [&](const HardRun& r) { return of(r) && r.run.goal == goal; }));
    }
    std::vector<std::size_t> order(plan.families.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (all[a].silent != all[b].silent) return all[a].silent_share() > all[b].silent_share();
        return here[a].honest_share() < here[b].honest_share();
    });
    MarkdownTable table({"family", "runs", "silent", "silent at the cap", "with warning", "no value",
                         "honest" + at, "median evaluations" + at});
    for (std::size_t f : order) {
        if (all[f].runs == 0) continue;
        table.add({std::string(plan.families[f]->name), std::to_string(all[f].runs),
                   counted_share(all[f].silent, all[f].runs), share_of(all[f].silent_at_cap, all[f].runs),
                   share_of(all[f].warned, all[f].runs), share_of(all[f].failed, all[f].runs),
                   percent(here[f].honest_share()), count_or_none(here[f].median_evaluations())});
    }
    out << "\n## Families, " << plain_name(plan.methods[method].name) << "\n\n" << table;
}

void add_coverage(MarkdownTable& table, const std::string& name, std::string_view law, const HardCell& cell) {
    const auto* freedom = std::find_if(std::begin(freedoms), std::end(freedoms),
                                       [&](const Freedom& f) { return f.method == law; });
    const bool known = freedom != std::end(freedoms);
    const double degrees = known ? freedom->degrees : 0;
    auto predicted = [&](double errors) {
        if (law == "cubature") return std::string("-");
        return percent(2 * (degrees > 0 ? student_t_cdf(errors, degrees) : normal_cdf(errors)) - 1);
    };
    std::string note = known ? std::string(freedom->note) : "-";
    if (degrees > 0) note = formatted("%.0f: ", degrees) + note;
    table.add({name, std::to_string(cell.converged), share_of(cell.within_one, cell.converged), predicted(1),
               share_of(cell.within_two, cell.converged), predicted(2), note});
}

// An automatic method has a line for each method that it picked.
void print_coverage(std::ostream& out, const HardPlan& plan, const std::vector<HardRun>& runs) {
    MarkdownTable table(
        {"method", "converged", "within 1", "predicted", "within 2", "predicted", "degrees of freedom"});
    for (std::size_t m = 0; m < plan.methods.size(); ++m) {
        const std::string name = plain_name(plan.methods[m].name);
        std::set<std::string> picked;
        for (const HardRun& r : runs)
            if (r.run.method == m && r.converged()) picked.insert(r.run.answer.chosen);
        for (const std::string& one : picked)
            add_coverage(table, one.empty() || one == name ? name : name + ": " + one,
                         one.empty() ? name : one, hard_cell(runs, [&](const HardRun& r) {
                             return r.run.method == m && r.run.answer.chosen == one;
                         }));
    }
    out << "\n## Coverage\n\nRuns that converged whose true error is within 1 and 2 claimed errors, and what "
           "the normal law or Student's predicts.\n\n"
        << table;
}

} // namespace

void print_hard_report(std::ostream& out, const HardPlan& plan, const std::vector<HardRun>& runs) {
    out << "# Hard integrals\n\n"
        << plan.families.size() << " families, " << plan.seeds << " seeds from " << plan.first_seed
        << ", at most " << short_count(static_cast<double>(plan.goals[0].evaluations)) << " evaluations and "
        << formatted("%g s", plan.seconds)
        << " a run. *Silent*: the run claims its target without a warning, and the true error is above 4 "
           "claimed ones. *Silent at the cap*: the same of a run that ended before its target. *Honest*: "
           "converged without a warning, true error within 4 claimed ones. Shares are of all runs.\n";
    print_methods(out, plan, runs);
    bool any = false;
    for (std::string_view wanted : {"auto", "adaptive", "vegas+"})
        for (std::size_t m = 0; m < plan.methods.size(); ++m)
            if (plain_name(plan.methods[m].name) == wanted) {
                print_families(out, plan, runs, m);
                any = true;
            }
    if (!any)
        for (std::size_t m = 0; m < plan.methods.size(); ++m) print_families(out, plan, runs, m);
    print_coverage(out, plan, runs);
}

void print_silent_failures(std::ostream& out, const HardPlan& plan, const std::vector<HardRun>& runs) {
    for (const HardRun& r : runs) {
        if (!r.silent() && !r.silent_at_cap()) continue;
        const Answer& answer = r.run.answer;
        out << (r.silent() ? "silent " : "silent at the cap ") << plan.families[r.run.line]->name << " seed "
            << r.run.seed << " " << plan.methods[r.run.method].name << " at " << plan.goals[r.run.goal].name()
            << ", " << r.dimensions << " variables (" << r.parameters << "): exact "
            << formatted("%.9g", r.run.exact) << ", value " << formatted("%.9g", answer.value) << ", error "
            << formatted("%.2g", answer.error) << " ("
            << formatted("%.3g", std::abs(answer.value - r.run.exact) / answer.error) << " errors off), "
            << r.run.evaluations << " evaluations";
        if (!answer.chosen.empty()) out << ", " << answer.chosen;
        if (!answer.reason.empty()) out << " (" << answer.reason << ")";
        out << "\n";
    }
}

} // namespace montelux::bench
