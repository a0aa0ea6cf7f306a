// Evaluates an integrand at points of a mixture density: sums of replicates, and the points themselves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/adaptive/mixture_density.h"
#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/replicates.h"

namespace montelux {

// Points with the integrand's values and the density that drew them.
struct SamplePoints {
    PointBuffer x;
    ValueBuffer g;
    std::vector<double> density;
};

// Sums from evaluating points of a mixture.
struct MixtureSums {
    ReplicateSums sums; // of g / q
    NonFiniteCount non_finite;
    std::uint64_t evaluations = 0; // points outside the cube cost none
    ExtremeValues extremes;        // of g / q
    // Of the first component, for each channel: points, sums of g / q and of its squares.
    struct Channel {
        std::uint64_t count = 0;
        double sum = 0, squares = 0;
    };
    std::vector<Channel> channels;

    void merge(const MixtureSums& later);
    // Variance of the sum / n of the first component where the points of a channel are independent.
    double independent_variance(std::uint64_t n) const;

    // `load` keeps the number of replicates and components. Throws Error where the saved ones differ.
    void save(StateWriter& state) const;
    void load(StateReader& state);
};

// Evaluates, for each replicate r in [0, replicates), points [begin, end) of the mixture (multiples of
// its balanced_points()), which are scrambled Sobol' points of their own for each (key, channel, replicate).
// If `points` is given it receives all points in order; otherwise `device` draws and evaluates them, if there is one.
// Empty when cancelled.
std::optional<MixtureSums> sample_mixture(const Evaluator& evaluator, const MixtureDensity& mixture,
                                          std::uint64_t key, int replicates, std::uint64_t begin,
                                          std::uint64_t end, SamplePoints* points, const CancelFlag* cancel,
                                          DeviceValues* device = nullptr);

} // namespace montelux
