// An integrand under an adaptive map: values at a batch of points, and sums that judge the map.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/evaluator.h"
#include "montelux/mc/integrate/vegas/adaptive_map.h"
#include "montelux/mc/stats/pareto_tail.h"

namespace montelux {

class DeviceValues;

// Buffers of a batch, used again and again.
class MappedPoints {
  public:
    // Values of w_c = g_c(x(y)) |dx/dy|, whose mean over the map's cube is the integral of component c.
    // `inverse_scale` holds, for each component, 1 over its typical size.
    void evaluate(const Evaluator& g, const AdaptiveMap& map, const PointBatch& y,
                  std::span<const double> inverse_scale, NonFiniteCount& non_finite);
    // The same of points number, number + 1, ... that a device drew; `uniform` fills in their places y.
    void evaluate(const Evaluator& g, const AdaptiveMap& map, const DeviceValues& device,
                  std::uint64_t number, std::size_t n, const std::function<void(PointBuffer&)>& uniform,
                  std::span<const double> inverse_scale, NonFiniteCount& non_finite);
    // The same at points x of the integrand's cube, as if the map had drawn them.
    void evaluate_uniform(const Evaluator& g, const AdaptiveMap& map, const PointBatch& x,
                          std::span<const double> inverse_scale, NonFiniteCount& non_finite);
    // The same at points that a device drew.
    void evaluate_uniform(const Evaluator& g, const AdaptiveMap& map, const PointBatch& x,
                          const DeviceValues& device, std::uint64_t number,
                          std::span<const double> inverse_scale, NonFiniteCount& non_finite);

    std::size_t count() const { return jacobian_.size(); }
    // w_c.
    std::span<const double> values(int c) const { return values_.component(c); }
    // |dx/dy|.
    std::span<const double> jacobian() const { return jacobian_; }
    // The square of all components together: the sum of (w_c / scale_c)^2.
    std::span<const double> squares() const { return squares_; }

  private:
    void finish(std::span<const double> inverse_scale);

    PointBuffer x_;
    ValueBuffer values_;
    std::vector<double> jacobian_, squares_;
};

// Sums over points of the map, each with its share of a mean over the cube.
struct MapInsight {
    MapInsight() = default;
    explicit MapInsight(int components)
        : square(static_cast<std::size_t>(components)), uniform_square(square), absolute(square) {}

    std::vector<double> square;         // mean of w_c^2
    std::vector<double> uniform_square; // mean of g_c^2 over uniform points, w_c^2 / |dx/dy|
    std::vector<double> absolute;       // mean of |w_c|
    double size = 0;                    // mean of the root of squares()
    double largest_square = 0;          // of all points
    // Of |w_0|, or of its deviations within strata, times the point's share times the number of points.
    ParetoTail tail;
    std::uint64_t tail_values = 0;
    MapTraining training;
    NonFiniteCount non_finite;

    void add(const MappedPoints& points, std::span<const double> share);
    void merge(const MapInsight& later);
};

} // namespace montelux
