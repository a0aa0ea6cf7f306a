// Summary of a method's runs: medians, honesty, coverage.
#pragma once

#include "bench/integrate/runner.h"
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace montelux::bench {

// Fractions of runs whose true error was within 1, 2 and 3 claimed errors.
struct Coverage {
    std::array<double, 3> within{};
    int runs = 0;
};

// The runs of one method on one line with one goal.
struct Cell {
    int runs = 0, failed = 0;
    int answered = 0; // claimed the target without a warning
    int warned = 0;
    int silent = 0;                  // answered, with a true error above 3 targets
    int silent_warnings_ignored = 0; // the same, with warnings ignored
    std::optional<double>
        median_evaluations; // runs that did not answer count as infinite; none if most did not
    double median_cpu_seconds = 0;
    double rms = 0; // of the true relative error, over runs that answered (or over all, where a goal spends)
    Coverage coverage;   // of the runs that `rms` is of
    bool honest = false; // most runs answered, and rms is at most 1.5 targets
};

class Summary {
  public:
    Summary(const Plan& plan, const std::vector<Run>& runs);

    const Cell& cell(std::size_t line, std::size_t method, std::size_t goal) const {
        return cells_[(line * methods_ + method) * goals_ + goal];
    }
    // Over all lines of a group.
    Coverage coverage(Group group, std::size_t method, std::size_t goal) const;
    // The method with the smallest median among the honest ones that `allowed` admits.
    template <typename Allowed>
    std::optional<std::size_t> best(std::size_t line, std::size_t goal, const Allowed& allowed) const {
        std::optional<std::size_t> found;
        for (std::size_t m = 0; m < methods_; ++m) {
            const Cell& c = cell(line, m, goal);
            if (!allowed(m) || !c.honest) continue;
            if (!found || *c.median_evaluations < *cell(line, *found, goal).median_evaluations) found = m;
        }
        return found;
    }

  private:
    std::vector<Line> lines_;
    std::size_t methods_, goals_;
    std::vector<Cell> cells_;
};

} // namespace montelux::bench
