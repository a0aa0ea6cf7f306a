// Report of the runs over the bank: silent failures, honest convergence, coverage; as Markdown.
#pragma once

#include "bench/hard/hard_runner.h"
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace montelux::bench {

// Counts over some of the runs.
struct HardCell {
    int runs = 0;
    int silent = 0, silent_at_cap = 0;
    int honest = 0;    // converged, the truth within four claimed errors
    int converged = 0; // claims the target without a warning
    int warned = 0, failed = 0;
    int within_one = 0, within_two = 0; // of those that converged
    std::vector<double> evaluations;    // of those that converged

    void add(const HardRun& run);
    double silent_share() const { return runs > 0 ? static_cast<double>(silent) / runs : 0; }
    double honest_share() const { return runs > 0 ? static_cast<double>(honest) / runs : 0; }
    // Of the runs that converged.
    std::optional<double> median_evaluations() const;
};

// Over the runs that `admits`.
template <typename Admits>
HardCell hard_cell(const std::vector<HardRun>& runs, const Admits& admits) {
    HardCell cell;
    for (const HardRun& run : runs)
        if (admits(run)) cell.add(run);
    return cell;
}

void print_hard_report(std::ostream& out, const HardPlan& plan, const std::vector<HardRun>& runs);
// Each silent failure in words.
void print_silent_failures(std::ostream& out, const HardPlan& plan, const std::vector<HardRun>& runs);

} // namespace montelux::bench
