// Climbs from points of a cubature's check to the tops of peaks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_check.h"
#include "montelux/mc/integrate/cubature/cubature_regions.h"
#include "montelux/mc/integrate/evaluator.h"

namespace montelux {

// The tops become surprises of the check, which must outlive the climb, as must all else that it is made from.
class CubatureClimb {
  public:
    // `tolerance`: of the whole integral, one per component. At most `most` evaluations.
    CubatureClimb(const Evaluator& evaluator, const CubatureRegions& regions,
                  std::span<const double> tolerance, std::uint64_t most, CubatureCheck& check)
        : evaluator_(evaluator), regions_(regions), tolerance_(tolerance), most_(most), check_(check) {}

    // Climbs from the greatest surprises, which often lie in tails of peaks whose tops are in other regions.
    void from_surprises();
    // Climbs from hints that lie on no flank of a top found before: the values between dip.
    void from_hints();
    std::uint64_t evaluations() const { return evaluations_; }

  private:
    // The components' distances from `means`, or from zero, relative to their tolerances.
    double size(std::span<const double> value, std::span<const double> means) const;
    std::vector<double> sizes_at(const PointBatch& x, std::span<const double> means);
    bool is_on_flank(const CubatureWitness& w, const CubatureWitness& top);
    // False where too few evaluations are left, or no top was found.
    bool climb(const CubatureWitness& from);

    const Evaluator& evaluator_;
    const CubatureRegions& regions_;
    std::span<const double> tolerance_;
    std::uint64_t most_, evaluations_ = 0;
    CubatureCheck& check_;
};

} // namespace montelux
