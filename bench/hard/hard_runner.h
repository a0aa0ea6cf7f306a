// Runs methods over the bank of hard integrals, in processes of their own: one that hangs or crashes costs a
// run, not the comparison.
#pragma once

#include "bench/hard/bank.h"
#include "bench/integrate/runner.h"
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace montelux::bench {

struct HardPlan {
    std::vector<const HardFamily*> families;
    std::vector<Method> methods;
    std::vector<Goal> goals;
    std::uint64_t first_seed = 0, seeds = 40;
    double seconds = 60;   // wall time that a method may take where it knows such a limit
    double patience = 150; // wall time after which a run is ended by force
    int jobs = 1;          // processes at a time
};

// `run.line` is the family in the plan's list.
struct HardRun {
    Run run;
    int dimensions = 0;
    double accuracy = 0; // of the exact value, relative
    std::string parameters;

    // The true error is within this many claimed ones, plus the uncertainty of the exact value.
    bool within(double errors) const;
    // Gave a value without a warning.
    bool unwarned() const { return run.failure.empty() && !run.answer.warned; }
    bool converged() const { return unwarned() && run.answer.converged; }
    // Claims its target; the truth is more than four claimed errors away.
    bool silent() const { return converged() && !within(4); }
    // The same of a run that ended before its target.
    bool silent_at_cap() const { return unwarned() && !run.answer.converged && !within(4); }
    bool honest() const { return converged() && within(4); }
};

using HardProgress = std::function<void(const HardRun&)>;

// In the order of families, seeds, methods, goals. `cancel` ends the comparison early, with the runs so far.
std::vector<HardRun> run_hard(const HardPlan& plan, const HardProgress& progress,
                              const CancelFlag* cancel = nullptr);

// One run in this process.
HardRun run_hard_one(const HardProblem& problem, const Method& method, const Request& request);

} // namespace montelux::bench
