// Prints results beside known values, and remembers whether they agree.
#pragma once

#include <cmath>
#include <iostream>
#include <montelux/mc/stats/estimate.h>
#include <string>

class Comparison {
  public:
    // Results agree within this many standard errors of the known value.
    explicit Comparison(double most_errors = 3) : most_errors_(most_errors) {}

    // `known` may have an error of its own, independent of the result's.
    void add(const std::string& what, const montelux::Estimate& result, double known,
             double known_error = 0) {
        const double distance = std::abs(result.value - known);
        const double error = std::hypot(result.standard_error, known_error);
        const bool agrees = distance <= most_errors_ * error + 1e-14 * std::abs(known);
        const auto digits = std::cout.precision(10);
        std::cout << what << " = " << result << "   known: " << known;
        if (known_error > 0) std::cout << " +- " << known_error;
        std::cout << (agrees ? "   agrees\n" : "   DISAGREES\n");
        std::cout.precision(digits);
        exit_code_ |= !agrees;
    }
    int exit_code() const { return exit_code_; }

  private:
    double most_errors_;
    int exit_code_ = 0;
};
