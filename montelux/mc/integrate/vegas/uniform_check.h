// A check of an adapted sampler by uniform points.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/vegas/mapped_points.h"

namespace montelux {

// Uniform points beside those of a map, never part of its estimate. Two tests: is their mean the map's
// result, and do they find values where the map hardly ever samples? A narrow peak that the map knows and
// uniform points mostly miss raises no alarm in either.
class UniformCheck {
  public:
    UniformCheck() = default;
    explicit UniformCheck(int components) : moments_(components, false), expected_square_(moments_.means()) {}

    std::uint64_t count() const { return moments_.count(); }
    const CovarianceMoments& moments() const { return moments_; }

    // Evaluates `points` uniform points of stream (seed, stream), after an iteration of the map that had
    // `weight` points and gave this insight. `device` may be null. False (and nothing changed) when cancelled.
    bool run(const Problem& problem, DeviceValues* device, const AdaptiveMap& map, const MapInsight& insight,
             double weight, std::uint64_t points, std::uint32_t stream, std::span<const double> inverse_scale,
             NonFiniteCount& non_finite, const CancelFlag* cancel);

    // Warnings for the result and its errors.
    void warn(const std::vector<double>& value, const std::vector<double>& standard_error,
              std::span<const double> inverse_scale, std::vector<std::string>& warnings) const;

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    CovarianceMoments moments_;           // moments of g_c over the uniform points
    std::vector<double> expected_square_; // mean of g_c^2 by the map
    double size_ = 0;                     // integral of the components' common size by the map
    double weight_ = 0;                   // points of the map
    double hidden_ = 0;                   // sum of hidden sizes over uniform points
    double largest_square_ = 0;           // of the map's points
};

} // namespace montelux
