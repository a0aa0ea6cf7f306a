// Totals of a cubature's regions: the value of each component, and its error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_confirmation.h"
#include "montelux/mc/integrate/cubature/cubature_regions.h"
#include "montelux/mc/integrate/cubature/cubature_verification.h"
#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// The errors of the regions are enlarged by the factor by which those of recently halved regions were too small.
class CubatureTotals {
  public:
    explicit CubatureTotals(int components);

    // Of a step that halves regions: compare() follows for each component of each region, with the error that was
    // predicted, and the difference of its value from that of its halves.
    void begin_comparison();
    void compare(std::size_t component, double predicted, double difference);
    void add_up(const CubatureRegions& regions, const CubatureVerification& verification,
                const CubatureConfirmation& confirmation, std::uint64_t evaluations);

    const std::vector<double>& value() const { return value_; }
    const std::vector<double>& error() const { return error_; }
    // Integrals of the absolute values, roughly.
    const std::vector<double>& absolute() const { return absolute_; }
    // Without the part for equal values, which halving does not reduce.
    const std::vector<double>& rule_error() const { return rule_error_; }
    double inflation(std::size_t component) const { return inflation_[component]; }
    // Was the integrand the same at all points, and not zero? A constant beside other components, as for a
    // normalisation, does not count.
    bool equal_values() const;
    // Factor on errors where few regions have tested one another yet.
    static double caution(std::size_t regions);

    // The comparisons; the rest follows from the regions by add_up.
    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    std::vector<double> value_, error_, rule_error_, inflation_, absolute_;
    std::vector<char> equal_; // were all values the same, other than zero?
    // Recent squared differences of regions from their halves, and the squares that their errors predicted.
    std::vector<double> disagreement_, expected_;
};

} // namespace montelux
