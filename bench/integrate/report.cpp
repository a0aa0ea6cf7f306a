#include "bench/integrate/report.h"

#include "bench/integrate/markdown.h"
#include "bench/integrate/published.h"
#include <algorithm>
#include <map>
#include <optional>
#include <ostream>
#include <utility>

namespace montelux::bench {

namespace {

std::vector<std::string> header(std::string first, const Plan& plan) {
    std::vector<std::string> row{std::move(first)};
    for (const Method& method : plan.methods) row.push_back(method.name);
    return row;
}

// A median with `!` where the claims are not honest, `?` where some runs had a warning, or `-` where most runs did
// not answer.
std::string median_text(const Cell& cell) {
    if (cell.failed == cell.runs) return "";
    if (!cell.median_evaluations) return cell.warned > 0 ? "-?" : "-";
    std::string text = short_count(*cell.median_evaluations);
    if (!cell.honest) text += "!";
    if (cell.warned > 0) text += "?";
    return text;
}

void print_medians(std::ostream& out, const Plan& plan, const Summary& summary, std::size_t goal) {
    out << "\n## Median evaluations to a claimed relative error of " << plan.goals[goal].name() << "\n\n"
        << "`!`: RMS true error above 1.5 targets; `?`: some runs had a warning; `-`: most runs did "
           "not "
           "reach the target or had a warning.\n\n";
    MarkdownTable table(header("line", plan));
    for (std::size_t l = 0; l < plan.lines.size(); ++l) {
        std::vector<std::string> row{line_name(plan.lines[l])};
        for (std::size_t m = 0; m < plan.methods.size(); ++m)
            row.push_back(median_text(summary.cell(l, m, goal)));
        table.add(row);
    }
    out << table;

    out << "\nMedian CPU time, milliseconds:\n\n";
    MarkdownTable times(header("line", plan));
    for (std::size_t l = 0; l < plan.lines.size(); ++l) {
        std::vector<std::string> row{line_name(plan.lines[l])};
        for (std::size_t m = 0; m < plan.methods.size(); ++m)
            row.push_back(formatted("%.3g", 1e3 * summary.cell(l, m, goal).median_cpu_seconds));
        times.add(row);
    }
    out << times;
}

struct Rival {
    std::string name;
    double evaluations;
    std::string text() const { return name + " " + short_count(evaluations); }
};

// The best honest rival of a kind, measured in this run; for sampling also the published one where it cannot
// be measured, marked with an asterisk.
std::optional<Rival> best_rival(const Plan& plan, const Summary& summary, std::size_t line, std::size_t goal,
                                Kind kind) {
    std::optional<Rival> best;
    const auto measured = summary.best(
        line, goal, [&](std::size_t m) { return !plan.methods[m].ours && plan.methods[m].kind == kind; });
    if (measured)
        best = Rival{plan.methods[*measured].name, *summary.cell(line, *measured, goal).median_evaluations};
    const auto published = published_medians(plan.lines[line], plan.goals[goal].relative_error);
    if (published && kind == Kind::sampling && only_published(published->best_sampling) &&
        (!best || published->sampling < best->evaluations))
        best = Rival{std::string(published->best_sampling) + "*", published->sampling};
    return best;
}

void print_ratios(std::ostream& out, const Plan& plan, const Summary& summary, std::size_t goal) {
    out << "\n## Evaluations of Montelux over those of rivals, relative error " << plan.goals[goal].name()
        << "\n\nEach of our sampling methods over the best honest sampling rival, `auto` and our rules over "
           "the best "
           "honest one of either kind, and our best over vegas+ (honest or not). Below 1 is better. "
           "`*`: not measured in this run, from the published table; `-`: no honest answer of ours; `only "
           "us`: "
           "no honest rival.\n\n";
    std::vector<std::string> head{"line", "best sampling rival", "best cubature rival"};
    for (const Method& method : plan.methods)
        if (method.ours) head.push_back(method.name);
    head.push_back("best of ours / vegas+");
    MarkdownTable table(head);
    std::size_t vegas = plan.methods.size();
    for (std::size_t m = 0; m < plan.methods.size(); ++m)
        if (plan.methods[m].name == "vegas+") vegas = m;
    for (std::size_t l = 0; l < plan.lines.size(); ++l) {
        const auto sampling = best_rival(plan, summary, l, goal, Kind::sampling);
        const auto rule = best_rival(plan, summary, l, goal, Kind::cubature);
        std::vector<std::string> row{line_name(plan.lines[l]), sampling ? sampling->text() : "-",
                                     rule ? rule->text() : "-"};
        for (std::size_t m = 0; m < plan.methods.size(); ++m) {
            if (!plan.methods[m].ours) continue;
            const Cell& cell = summary.cell(l, m, goal);
            std::optional<double> rival;
            if (sampling) rival = sampling->evaluations;
            if (plan.methods[m].kind != Kind::sampling && rule)
                rival = rival ? std::min(*rival, rule->evaluations) : rule->evaluations;
            row.push_back(!cell.honest ? "-"
                          : !rival     ? "only us"
                                       : formatted("%.2g", *cell.median_evaluations / *rival));
        }
        const auto ours = summary.best(l, goal, [&](std::size_t m) { return plan.methods[m].ours; });
        const bool comparable =
            ours && vegas < plan.methods.size() && summary.cell(l, vegas, goal).median_evaluations;
        row.push_back(comparable ? formatted("%.2g", *summary.cell(l, *ours, goal).median_evaluations /
                                                         *summary.cell(l, vegas, goal).median_evaluations)
                                 : "-");
        table.add(row);
    }
    out << table;
}

std::string coverage_text(const Coverage& coverage) {
    if (coverage.runs == 0) return "";
    return formatted("%.2f/", coverage.within[0]) + formatted("%.2f/", coverage.within[1]) +
           formatted("%.2f", coverage.within[2]);
}

void print_honesty(std::ostream& out, const Plan& plan, const Summary& summary, std::size_t goal) {
    const bool spends = plan.goals[goal].spends();
    out << "\n## Honesty at " << plan.goals[goal].name() << "\n\n";
    if (spends)
        out << "Coverage: share of runs whose true error is within 1/2/3 claimed errors.\n\n";
    else
        out << "Silent failures: target claimed without a warning, true error above 3 targets. Coverage: "
               "share "
               "of the "
               "runs that answered whose true error is within 1/2/3 claimed errors.\n\n";
    MarkdownTable table({"method", "runs", "answered", "warned", "silent", "warnings ignored", "smooth",
                         "discontinuous", "1-D", "hard"});
    for (std::size_t m = 0; m < plan.methods.size(); ++m) {
        int runs = 0, answered = 0, warned = 0, silent = 0, ignoring_warnings = 0;
        for (std::size_t l = 0; l < plan.lines.size(); ++l) {
            const Cell& cell = summary.cell(l, m, goal);
            runs += cell.runs - cell.failed;
            answered += cell.answered;
            warned += cell.warned;
            silent += cell.silent;
            ignoring_warnings += cell.silent_warnings_ignored;
        }
        auto share = [&](int count) { return runs > 0 ? formatted("%.1f %%", 100.0 * count / runs) : ""; };
        auto covered = [&](Group group) { return coverage_text(summary.coverage(group, m, goal)); };
        table.add({plan.methods[m].name, std::to_string(runs), spends ? "" : share(answered), share(warned),
                   spends ? "" : share(silent), spends ? "" : share(ignoring_warnings),
                   covered(Group::smooth), covered(Group::discontinuous), covered(Group::one_dimensional),
                   covered(Group::hard)});
    }
    if (plan.goals[goal].relative_error == 1e-3)
        for (const PublishedHonesty& row : published_honesty())
            if (only_published(row.method))
                table.add({std::string(row.method) + "*", "", "", "", "", std::string(row.silent_1e3),
                           std::string(row.smooth), std::string(row.discontinuous)});
    out << table << "\n`*`: not measured in this run, from the published table.\n";
}

void print_errors(std::ostream& out, const Plan& plan, const Summary& summary, std::size_t goal) {
    out << "\n## RMS true relative error at " << plan.goals[goal].name() << "\n\n";
    std::vector<std::string> head = header("line", plan);
    const bool published = plan.goals[goal].evaluations == 1000000;
    if (published) head.insert(head.end(), {"Cuba Vegas Sobol'*", "qmc*"});
    MarkdownTable table(head);
    for (std::size_t l = 0; l < plan.lines.size(); ++l) {
        std::vector<std::string> row{line_name(plan.lines[l])};
        for (std::size_t m = 0; m < plan.methods.size(); ++m) {
            const Cell& cell = summary.cell(l, m, goal);
            row.push_back(cell.coverage.runs == 0 ? "" : short_error(cell.rms));
        }
        const auto errors = published_errors(plan.lines[l]);
        if (published && errors)
            row.insert(row.end(), {short_error(errors->cuba_vegas_sobol), short_error(errors->qmc)});
        table.add(row);
    }
    out << table;
    if (published) out << "\n`*`: not measured in this run, from the published table.\n";
}

// What automatic methods picked, with the number of runs.
void print_choices(std::ostream& out, const Plan& plan, const std::vector<Run>& runs, std::size_t goal) {
    std::map<std::pair<std::size_t, std::size_t>, std::map<std::string, int>> picked; // by line and method
    for (const Run& run : runs)
        if (run.goal == goal && plan.methods[run.method].kind == Kind::either && !run.answer.chosen.empty())
            ++picked[{run.line, run.method}][run.answer.chosen];
    if (picked.empty()) return;
    out << "\n## What was picked at " << plan.goals[goal].name() << "\n\n";
    MarkdownTable table({"line", "method", "picked"});
    for (const auto& [key, choices] : picked) {
        std::string text;
        for (const auto& [name, count] : choices)
            text += (text.empty() ? "" : ", ") + name + " (" + std::to_string(count) + ")";
        table.add({line_name(plan.lines[key.first]), plan.methods[key.second].name, text});
    }
    out << table;
}

// Each message of a method that gave no answer, once a line.
void print_notes(std::ostream& out, const Plan& plan, const std::vector<Run>& runs) {
    std::vector<std::string> notes;
    for (const Run& run : runs)
        if (!run.failure.empty()) {
            const std::string note =
                plan.methods[run.method].name + " on " + line_name(plan.lines[run.line]) + ": " + run.failure;
            if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
        }
    if (!notes.empty()) out << "\nRuns without an answer:\n\n";
    for (const std::string& note : notes) out << "- " << note << "\n";
}

} // namespace

void print_report(std::ostream& out, const Plan& plan, const std::vector<Run>& runs, const Summary& summary) {
    for (std::size_t goal = 0; goal < plan.goals.size(); ++goal) {
        if (plan.goals[goal].spends()) {
            print_errors(out, plan, summary, goal);
        } else {
            print_medians(out, plan, summary, goal);
            print_ratios(out, plan, summary, goal);
        }
        print_honesty(out, plan, summary, goal);
        print_choices(out, plan, runs, goal);
    }
    print_notes(out, plan, runs);
}

void print_scaling(std::ostream& out, std::span<const Scaling> scaling) {
    out << "\n## Two threads: wall time with an integrand of about 100 ns in 8 dimensions\n\n";
    MarkdownTable table({"method", "ns on one thread", "speedup on two"});
    for (const Scaling& row : scaling)
        table.add(
            {row.method, formatted("%.0f", row.nanoseconds_on_one), formatted("%.2f", row.speedup_on_two)});
    out << table;
}

void print_overheads(std::ostream& out, std::span<const Overhead> overheads) {
    out << "\n## Overhead: CPU nanoseconds an evaluation, sum of 8 coordinates\n\n";
    MarkdownTable table({"method", "form", "ns"});
    for (const Overhead& row : overheads)
        table.add(
            {row.method, row.form == Form::batch ? "batch" : "scalar", formatted("%.1f", row.nanoseconds)});
    for (const PublishedOverhead& row : published_overheads())
        table.add({std::string(row.method) + "*", "", std::string(row.nanoseconds)});
    out << table << "\n`*`: not measured in this run, from the published table, on another machine.\n";
}

} // namespace montelux::bench
