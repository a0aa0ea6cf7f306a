// Confirmation of a cubature's errors: some regions are halved, and their values compared with those of the halves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_regions.h"
#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// The largest errors are halved first, so what remains was not tried. Where an integrand has the same shape in many
// regions (a jump parallel to an axis, a singular line) null rules may be too optimistic in all of them, and random
// points do not show differences as small as the target. A sample of the regions, mostly by their errors, estimates
// by how much the value would move if all were halved.
class CubatureConfirmation {
  public:
    explicit CubatureConfirmation(int components) : factor_(static_cast<std::size_t>(components), 1.0) {}

    // A result claims its target.
    void require(const CubatureRegions& regions);
    bool pending() const { return pending_; }
    // The regions to halve; empty if none can be. `scale`: of each component's errors. At most about `most`, at least
    // one.
    std::vector<std::size_t> choose(const CubatureRegions& regions, std::span<const double> scale,
                                    std::size_t most, std::uint64_t seed);
    // The values of the chosen regions and of their halves, two by two, and the errors claimed for the whole.
    void compare(const CubatureRegions& regions, std::span<const std::size_t> chosen,
                 const CubatureRegions& halves, std::span<const double> claimed);
    // There is nothing to halve, or no evaluation left.
    void skip() { pending_ = false; }

    // By which a component's errors must grow.
    double factor(std::size_t component) const { return factor_[component]; }

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    std::vector<double> factor_;
    std::vector<double> probability_; // of having chosen each of the regions
    std::uint64_t rounds_ = 0;
    std::uint64_t confirmed_ = 0; // regions at the last confirmation that found nothing; 0: none did
    bool pending_ = false;
};

} // namespace montelux
