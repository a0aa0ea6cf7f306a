// Runs every method on every line, target and seed, and keeps the answers.
#pragma once

#include "bench/integrate/integrands.h"
#include "bench/integrate/method.h"
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux::bench {

// A relative error to be reached, or a number of evaluations to be spent.
struct Goal {
    double relative_error = 0;
    std::uint64_t evaluations = 0; // the cap, or the number to be spent

    bool spends() const { return !(relative_error > 0); }
    // "1e-3", or "1e6 evaluations".
    std::string name() const;
    friend bool operator==(const Goal&, const Goal&) = default;
};

struct Run {
    std::size_t line = 0, method = 0, goal = 0; // in the plan's lists
    std::uint64_t seed = 0;
    Answer answer;
    double exact = 0;
    std::uint64_t evaluations = 0;
    double cpu_seconds = 0;
    std::string failure; // the method's message, where it gave no answer

    double relative_error() const { return (answer.value - exact) / exact; }
    // It gave an answer: target reached, no warning.
    bool answered() const { return failure.empty() && answer.converged && !answer.warned; }
};

struct Plan {
    std::vector<Line> lines;
    std::vector<Method> methods;
    std::vector<Goal> goals;
    std::uint64_t seeds = 20;
};

// Called after all seeds of a line, goal and method.
using Progress = std::function<void(const Line&, const Goal&, const Method&, double cpu_seconds)>;

// `cancel` is asked before each run; what was run until then is returned.
std::vector<Run> run_all(const Plan& plan, const Progress& progress, const CancelFlag* cancel = nullptr);

// One run, its list indices left at 0.
Run run_one(const Method& method, const BenchProblem& problem, const Request& request);

// CPU time of this process so far.
double process_cpu_seconds();

struct Overhead {
    std::string method;
    Form form;
    double nanoseconds; // CPU time an evaluation, the integrand (a sum of 8 numbers) included
    std::uint64_t evaluations;
};

// The cost of each method and form with a trivial integrand in 8 dimensions: the least of three runs.
std::vector<Overhead> measure_overhead(const std::vector<Method>& methods, std::uint64_t evaluations);

} // namespace montelux::bench
