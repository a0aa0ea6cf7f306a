// Interface of an integrator, ours or another's, to the comparison.
#pragma once

#include "bench/integrate/problem.h"
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace montelux::bench {

// An integrand that counts its evaluations; methods see no other, so that every pilot and rerun is counted.
// For one thread.
class CountedIntegrand {
  public:
    explicit CountedIntegrand(const BenchProblem& problem) : problem_(problem) {}

    const BenchProblem& problem() const { return problem_; }
    int dimensions() const { return problem_.dimensions(); }
    std::uint64_t evaluations() const { return evaluations_; }

    double operator()(const double* x) const {
        ++evaluations_;
        return problem_(x);
    }
    void evaluate(const double* const* x, std::size_t n, double* values) const {
        evaluations_ += n;
        problem_.evaluate(x, n, values);
    }
    double on_unit_cube(const double* u) const {
        ++evaluations_;
        return problem_.on_unit_cube(u);
    }
    void rows_on_unit_cube(const double* u, std::size_t n, double* values) const {
        evaluations_ += n;
        problem_.rows_on_unit_cube(u, n, values);
    }

  private:
    const BenchProblem& problem_;
    mutable std::uint64_t evaluations_ = 0;
};

// How the integrand is called: point by point or many points at once.
enum class Form { scalar, batch };

struct Request {
    double relative_error = 0;     // 0: spend the evaluations
    std::uint64_t evaluations = 0; // the cap, or the number to be spent
    std::uint64_t seed = 0;
    Form form = Form::batch;
    double seconds = 0; // wall time, for methods that know a limit of it; 0: none
};

struct Answer {
    double value = 0;
    double error = 0;       // the error that the method claims: one standard deviation, or a rule's estimate
    bool converged = false; // it claims the relative error asked for
    bool warned = false;    // its own diagnostics give a warning
    std::string chosen;     // the method that an automatic one picked
    std::string reason;     // why it did
    std::string warnings;   // its diagnostics, where it has any, in words
    bool out_of_time = false;
    // For methods that run in another process.
    std::optional<std::uint64_t> evaluations;
    std::optional<double> cpu_seconds;
};

enum class Kind { sampling, cubature, either };

struct Method {
    std::string name;
    Kind kind = Kind::sampling;
    bool ours = false;
    std::vector<Form> forms{Form::batch}; // the first is the one that lines are measured with
    std::function<Answer(const CountedIntegrand&, const Request&)> run;
    bool by_default = true; // part of a comparison that names no methods
};

} // namespace montelux::bench
