// The bank of hard integrals: families with random parameters and known values.
#pragma once

#include "bench/integrate/problem.h"
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::bench {

class Draws;

// One member of a family.
struct HardIntegral {
    std::vector<Range> ranges;
    std::function<double(const double*)> f;
    double exact = 0;
    std::string parameters;  // in words
    double accuracy = 1e-12; // bound on the relative error of `exact`
};

// A seed draws the number of variables, the variant and the parameters. The numbers are those of Philox,
// keyed by name and seed; `formula`, beside each family in its source, gives integrand, distribution of the
// parameters and source of the exact value.
struct HardFamily {
    std::string_view name;
    std::string_view formula;
    HardIntegral (*draw)(Draws& draws);
};

// The families that constants of integrators are set on.
std::span<const HardFamily> hard_families();
// Families that judge: no constant of an integrator may be set on them. Not among hard_families().
std::span<const HardFamily> judging_families();
const HardFamily* hard_family_named(std::string_view name);

class HardProblem final : public BenchProblem {
  public:
    HardProblem(const HardFamily& family, std::uint64_t seed);

    std::string name() const override { return std::string(family_->name); }
    double operator()(const double* x) const override { return integral_.f(x); }
    const std::string& parameters() const { return integral_.parameters; }
    double accuracy() const { return integral_.accuracy; }

  private:
    const HardFamily* family_;
    HardIntegral integral_;
};

// The families by source file.
std::span<const HardFamily> peak_families();
std::span<const HardFamily> shell_families();
std::span<const HardFamily> ridge_families();
std::span<const HardFamily> jump_families();
std::span<const HardFamily> singular_families();
std::span<const HardFamily> infinite_families();
std::span<const HardFamily> physics_families();
std::span<const HardFamily> option_families();
std::span<const HardFamily> high_dimensional_families();
std::span<const HardFamily> control_families();

} // namespace montelux::bench
