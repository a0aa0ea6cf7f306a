// An integral over a box with a known value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/domain.h"

namespace montelux::bench {

class BenchProblem {
  public:
    virtual ~BenchProblem() = default;

    // From its name and its seed another process makes the same problem.
    virtual std::string name() const = 0;
    std::uint64_t seed() const { return seed_; }
    int dimensions() const { return domain_.dimensions(); }
    const Domain& domain() const { return domain_; }
    // Of each coordinate; ends may be infinite.
    std::span<const Range> ranges() const { return domain_.ranges(); }
    // The integral over the box.
    double exact() const { return exact_; }

    // At one point of the box.
    virtual double operator()(const double* x) const = 0;
    // At n points in structure of arrays: coordinate j of point i is x[j][i].
    virtual void evaluate(const double* const* x, std::size_t n, double* values) const;

    // The integrand carried to the unit cube by the map of Domain, with the Jacobian of the map in it: its
    // integral over the cube is exact(). A value that is not finite is returned as 0.
    double on_unit_cube(const double* u) const;
    // Row after row: coordinate j of point i is u[i * dimensions + j].
    void rows_on_unit_cube(const double* u, std::size_t n, double* values) const;

  protected:
    explicit BenchProblem(std::uint64_t seed) : seed_(seed) {}
    BenchProblem(const BenchProblem&) = default;
    BenchProblem& operator=(const BenchProblem&) = default;

    void set_ranges(std::vector<Range> ranges) { domain_ = Domain(std::move(ranges)); }
    void set_exact(double exact) { exact_ = exact; }

  private:
    Domain domain_ = Domain::unit_cube(1);
    std::uint64_t seed_;
    double exact_ = 0;
};

} // namespace montelux::bench
