// Compensated summation: running sums whose rounding error does not grow with their length.
#pragma once

#include <cmath>

namespace montelux {

// Neumaier 1974, "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen".
class CompensatedSum {
  public:
    constexpr CompensatedSum() = default;
    explicit constexpr CompensatedSum(double v) : sum_(v) {}

    void add(double v) {
        double t = sum_ + v;
        error_ += std::abs(sum_) >= std::abs(v) ? (sum_ - t) + v : (v - t) + sum_;
        sum_ = t;
    }
    void add(const CompensatedSum& other) {
        add(other.sum_);
        error_ += other.error_;
    }
    double value() const { return sum_ + error_; }

  private:
    double sum_ = 0, error_ = 0;
};

} // namespace montelux
