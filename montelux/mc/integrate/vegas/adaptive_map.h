// A map of the unit cube onto itself, coordinate by coordinate, that learns where an integrand is large.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/points.h"
#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// Training data of a map: for each increment of each coordinate, the mean of (g |dx/dy|)^2 over its points.
class MapTraining {
  public:
    // Empty.
    MapTraining() = default;
    MapTraining(int dimensions, int increments)
        : increments_(increments),
          sums_(static_cast<std::size_t>(dimensions) * static_cast<std::size_t>(increments)) {}

    bool active() const { return increments_ > 0; }
    int increments() const { return increments_; }
    // Points y of the map's own cube. `share[i]` is the weight of point i in a mean over the cube (the shares
    // of all points add up to 1), `weighted_square[i]` that share times (g |dx/dy|)^2.
    void add(const PointBatch& y, std::span<const double> share, std::span<const double> weighted_square);
    void merge(const MapTraining& other);
    // Mean of the squares in each increment of coordinate d; increments without points take their
    // neighbours' value.
    std::vector<double> means(int d) const;

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    struct Sum {
        double share = 0, square = 0;
    };
    int increments_ = 0;
    std::vector<Sum> sums_; // all increments of a coordinate together
};

// x_d(y_d) is piecewise linear: increment i of the axis y, [i/n, (i+1)/n], goes to [edge i, edge i+1] of the
// axis x. The density of x(y), y uniform, is 1 / |dx/dy|, a product of step functions. Lepage 1978, "A New
// Algorithm for Adaptive Multidimensional Integration"; symbols of Lepage 2021, "Adaptive multidimensional
// integration: VEGAS enhanced", section II.
class AdaptiveMap {
  public:
    static constexpr int max_increments = 1 << 14;

    // The identity. Throws Error for less than one dimension, or increments outside [1, max_increments].
    explicit AdaptiveMap(int dimensions, int increments = 128);
    // From the edges of each coordinate: 0 first, 1 last, increasing, as many in each. Throws Error.
    explicit AdaptiveMap(const std::vector<std::vector<double>>& edges);

    int dimensions() const { return dimensions_; }
    int increments() const { return increments_; }
    // The increments + 1 edges of coordinate d, from 0 to 1.
    std::span<const double> edges(int d) const {
        return {edges_.data() + static_cast<std::size_t>(d) * stride(), stride()};
    }

    // x(y) for points y in [0, 1)^d; multiplies jacobian[i] by |dx/dy| at point i. x < 1.
    void map(const PointBatch& y, PointBuffer& x, std::span<double> jacobian) const;
    // y(x) for points x in [0, 1)^d; multiplies jacobian[i] by |dx/dy| there.
    void inverse(const PointBatch& x, PointBuffer& y, std::span<double> jacobian) const;

    // Moves the edges towards increments of equal mean squares, by smoothing those over neighbours and
    // compressing them with the power alpha (Lepage 2021, section II; 0 moves nothing, 0.5 slowly, 1.5 fast).
    // A thousandth of the density stays uniform in each coordinate, so that parts of the cube that training
    // has not seen stay reachable. Coordinates where all squares are zero do not change.
    void refine(const MapTraining& training, double alpha);
    // The same map (but for rounding corners) with another number of increments.
    AdaptiveMap resampled(int increments) const;

    // The map among other saved numbers; load throws Error for invalid edges.
    void save(StateWriter& state) const;
    static AdaptiveMap load(StateReader& state);
    // The map as a file of its own, written whole or not at all. Both throw Error.
    void save(const std::string& path) const;
    static AdaptiveMap load(const std::string& path);

    bool operator==(const AdaptiveMap&) const = default;

  private:
    std::size_t stride() const { return static_cast<std::size_t>(increments_) + 1; }

    int dimensions_, increments_;
    std::vector<double> edges_;
};

} // namespace montelux
