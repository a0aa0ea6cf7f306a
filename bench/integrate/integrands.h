// Integrands to compare quadrature programs: Genz's families, one-dimensional classics, hard peaks.
#pragma once

#include "bench/integrate/problem.h"
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace montelux::bench {

// Genz families (Genz 1984, "Testing multidimensional integration routines"), with w_j uniform in (0, 1) and
// c_j uniform in (0, 1), then scaled so that their sum is the difficulty given here (Hahn 2005, "Cuba - a
// library for multidimensional numerical integration"); on the unit cube:
//   oscillatory    cos(phase + sum c_j x_j), 6.0; the phase is such that the mean is cos of an angle uniform
//                  in +-pi/4 times prod sinc(c_j / 2), hence never near 0
//   product_peak   prod 1 / (c_j^-2 + (x_j - w_j)^2), 18.0
//   corner_peak    (1 + sum c_j x_j)^-(d + 1), 2.2
//   gaussian       exp(-sum c_j^2 (x_j - w_j)^2), 15.2
//   continuous     exp(-sum c_j |x_j - w_j|), 16.1: continuous, but not its slope
//   discontinuous  exp(sum c_j x_j) where x_1 <= w_1 and x_2 <= w_2, else 0, 16.4
// One dimension; the seed has no effect on the first four:
//   sine           sin x on [0, pi/2]
//   exponential    5 exp(-5 x) on [0, infinity)
//   quadratic      3 x^2 / 2 on [-1, 1]
//   inverse_root   1 / (2 sqrt x) on [0, 1], infinite at 0
//   jump           exp(x) for x <= w, else 0, on [0, 1], w uniform in (0.2, 0.8)
// Hard, on the unit cube. Every coordinate of every centre is moved by a number uniform in +-0.01, and so is
// each end of the ridge. Normalised to an integral of 1 over all of space:
//   two_peaks      mean of 2 Gaussians exp(-K |x - p|^2) at 1/3 and 2/3 of the diagonal, K = 100
//   three_peaks    of 3 at 0.23, 0.39, 0.74, K = 50
//   four_peaks     of 4 at 0.2, 0.4, 0.6, 0.8, K = 200: narrow
//   ridge          the Gaussian of K = 100, its centre averaged along the diagonal from 0.25 to 0.75
// For measuring what a method itself costs:
//   sum            x_1 + ... + x_d
enum class Family {
    oscillatory,
    product_peak,
    corner_peak,
    gaussian,
    continuous,
    discontinuous,
    sine,
    exponential,
    quadratic,
    inverse_root,
    jump,
    two_peaks,
    three_peaks,
    four_peaks,
    ridge,
    sum
};

// How a family's lines are gathered in tables.
enum class Group { smooth, discontinuous, one_dimensional, hard };

// A line of the tables: a family in a number of dimensions.
struct Line {
    Family family;
    int dimensions;

    friend bool operator==(const Line&, const Line&) = default;
};

// In the order of the tables; without `sum`.
std::span<const Line> bench_lines();
// "osc-5", "ridge-8", "sin", ...
std::string line_name(Line line);
// Also "sum-8".
std::optional<Line> line_named(std::string_view name);
Group line_group(Line line);

// One integrand: the parameters that a seed draws for a line, its integral known to at least 12 digits. The
// numbers are those of Philox, keyed by family, dimensions and seed: first all w, then all c, then the rest.
class BenchIntegrand final : public BenchProblem {
  public:
    static constexpr int max_dimensions = 8;
    static constexpr int max_peaks = 4;

    BenchIntegrand(Line line, std::uint64_t seed);

    Line line() const { return line_; }
    std::string name() const override { return line_name(line_); }
    // Range of a coordinate; all coordinates have the same one. The upper end may be infinite.
    double lower() const { return ranges()[0].lower; }
    double upper() const { return ranges()[0].upper; }

    double operator()(const double* x) const override;
    void evaluate(const double* const* x, std::size_t n, double* values) const override;

    // The parameters, by the symbols above; unused ones are 0.
    std::span<const double> c() const { return {c_.data(), static_cast<std::size_t>(line_.dimensions)}; }
    std::span<const double> w() const { return {w_.data(), static_cast<std::size_t>(line_.dimensions)}; }
    double phase() const { return phase_; }
    double narrowness() const { return narrowness_; } // K
    int peaks() const { return peaks_; }
    std::span<const double> peak(int k) const {
        return {centres_[static_cast<std::size_t>(k)].data(), static_cast<std::size_t>(line_.dimensions)};
    }
    // The ends of the ridge, as fractions of the diagonal.
    double ridge_begin() const { return begin_; }
    double ridge_end() const { return end_; }

  private:
    void draw_parameters(std::uint64_t seed);
    double ridge_value(double mean, double mean_square) const;

    Line line_;
    std::array<double, max_dimensions> w_{}, c_{};
    double phase_ = 0;
    double narrowness_ = 0;
    int peaks_ = 0;
    std::array<std::array<double, max_dimensions>, max_peaks> centres_{};
    double begin_ = 0, end_ = 0;
    double scale_ = 1; // of the peaks and the ridge, so that they are normalised
};

// The integral over the box of the integrand with these parameters.
double exact_integral(const BenchIntegrand& integrand);

} // namespace montelux::bench
