#include "bench/integrate/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace montelux::bench {

namespace {

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

Cell summarise(const std::vector<const Run*>& runs, const Goal& goal) {
    Cell cell;
    cell.runs = static_cast<int>(runs.size());
    std::vector<double> evaluations, cpu_seconds;
    double squares = 0;
    std::array<int, 3> within{};
    for (const Run* run : runs) {
        const bool counts = goal.spends() ? run->failure.empty() : run->answered();
        cell.failed += !run->failure.empty();
        cell.answered += run->answered();
        cell.warned += run->failure.empty() && run->answer.warned;
        cpu_seconds.push_back(run->cpu_seconds);
        evaluations.push_back(counts ? static_cast<double>(run->evaluations)
                                     : std::numeric_limits<double>::infinity());
        const double error = std::abs(run->relative_error());
        cell.silent_warnings_ignored +=
            run->failure.empty() && run->answer.converged && error > 3 * goal.relative_error;
        if (!counts) continue;
        cell.silent += run->answered() && error > 3 * goal.relative_error;
        squares += error * error;
        ++cell.coverage.runs;
        for (int k = 0; k < 3; ++k)
            within[k] += std::abs(run->answer.value - run->exact) <= (k + 1) * run->answer.error;
    }
    const int counted = cell.coverage.runs;
    if (counted > 0) {
        cell.rms = std::sqrt(squares / counted);
        for (int k = 0; k < 3; ++k) cell.coverage.within[k] = static_cast<double>(within[k]) / counted;
    }
    const double middle = median(evaluations);
    if (std::isfinite(middle) && !runs.empty()) cell.median_evaluations = middle;
    cell.median_cpu_seconds = median(cpu_seconds);
    cell.honest = cell.median_evaluations && !goal.spends() && cell.rms <= 1.5 * goal.relative_error;
    return cell;
}

} // namespace

Summary::Summary(const Plan& plan, const std::vector<Run>& runs)
    : lines_(plan.lines), methods_(plan.methods.size()), goals_(plan.goals.size()) {
    std::vector<std::vector<const Run*>> sorted(lines_.size() * methods_ * goals_);
    for (const Run& run : runs)
        sorted[(run.line * methods_ + run.method) * goals_ + run.goal].push_back(&run);
    for (std::size_t i = 0; i < sorted.size(); ++i)
        cells_.push_back(summarise(sorted[i], plan.goals[i % goals_]));
}

Coverage Summary::coverage(Group group, std::size_t method, std::size_t goal) const {
    Coverage total;
    for (std::size_t l = 0; l < lines_.size(); ++l) {
        if (line_group(lines_[l]) != group) continue;
        const Coverage& c = cell(l, method, goal).coverage;
        for (int k = 0; k < 3; ++k) total.within[k] += c.within[k] * c.runs;
        total.runs += c.runs;
    }
    for (double& fraction : total.within) fraction = total.runs > 0 ? fraction / total.runs : 0;
    return total;
}

} // namespace montelux::bench
