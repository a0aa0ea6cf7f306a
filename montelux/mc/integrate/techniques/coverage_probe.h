// Looks for places where an integrand is not zero but no technique can draw a point.
#pragma once

#include <vector>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/techniques/technique.h"

namespace montelux {

// Where all densities are zero but the integrand is not, a part of the integral is missing from the estimate
// and from its error, and no sample shows it. Uniform points of the unit cube, mapped to the domain, do. They
// never enter the estimate; their sum is the missing part.
class CoverageProbe {
  public:
    explicit CoverageProbe(std::vector<Technique> techniques) : techniques_(std::move(techniques)) {}

    std::uint64_t evaluations() const { return evaluations_; }
    // How many more to evaluate before the next step of an estimator that has `samples` samples and may make
    // `limit` evaluations: for one probe to 32 samples after a doubling, and 32 at first.
    std::uint64_t due(std::uint64_t samples, std::uint64_t limit) const;
    // Evaluates further points; false, and nothing changed, when cancelled.
    bool run(const Problem& problem, std::uint64_t points, const CancelFlag* cancel);
    // Adds a warning that names a point, if one was found and the missing part is not small compared with the
    // errors.
    void warn(Tally& tally) const;

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    std::vector<Technique> techniques_;
    std::uint64_t evaluations_ = 0, uncovered_ = 0;
    std::vector<double> first_point_; // empty while none is uncovered
    double first_value_ = 0;
    std::vector<double> missing_; // sums of |f| |dx/du| of each component; empty while none is uncovered
    double missing_square_ = 0;   // sum of squares of the first one's
};

} // namespace montelux
