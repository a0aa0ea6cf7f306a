// Adaptive Monte Carlo (A10): maps that follow the integrand, with adaptive stratification or on Sobol'
// points.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/vegas/adaptive_map.h"

namespace montelux {

// VEGAS+ (Lepage 2021, "Adaptive multidimensional integration: VEGAS enhanced"): points y stratified over
// hypercubes of the unit cube, with more points where the values spread, are mapped to x(y), coordinate by
// coordinate, so that the values g(x(y)) |dx/dy| become as equal as possible. Map and strata are trained
// after each iteration for the next one.
//
// Unbiased for any number of evaluations: the first iterations only train, and the others are weighted by
// their numbers of points, not by their own variances. Additional uniform points check that the map has not
// lost a part of the integral; iterations are compared by chi-squared; and a sum dominated by a few points
// gives a warning. A part so narrow that no point came near is not found.
//
// Vector-valued integrands are trained on the sum of squared components, each relative to its mean square.
struct Vegas {
    static constexpr std::string_view name = "vegas";
    static constexpr FirstLookUse first_look = FirstLookUse::always;
    static constexpr bool on_device = true;

    enum class Points : std::uint8_t {
        stratified, // pseudo-random, in hypercubes
        // Randomised Sobol' points under the map; they are stratified by themselves, so there are no
        // hypercubes. The error comes from `replicates`. Iterations grow sixteenfold, with the map fixed
        // while one runs, and are weighted by the squares of their lengths.
        sobol
    };
    Points points = Points::stratified;
    // How fast the map moves; 0 keeps it.
    double alpha = 1;
    // Points of a hypercube are proportional to the spread of its values to this power; 0: equal.
    double beta = 0.75;
    // Iterations at the start that only train. More follow while they help much, up to a quarter of the
    // allowed evaluations. With 0 the first iteration counts, which suits a trained map.
    int training_iterations = 5;
    // Evaluations of each; 0: automatic (about 2000 in eight dimensions).
    std::uint64_t training_evaluations = 0;
    // Maximum increments of the map per coordinate; fewer while there are few points.
    int increments = 512;
    // Uniform points for each point of the estimate, [0, 1].
    double uniform_share = 0.05;
    // Of Sobol' points.
    int replicates = 16;
    // Where the map starts; none: the identity. Its number of increments then stays.
    std::optional<AdaptiveMap> map = std::nullopt;

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

// Vegas on Sobol' points, under a name of its own.
struct VegasSobol {
    static constexpr std::string_view name = "vegas_sobol";
    static constexpr FirstLookUse first_look = FirstLookUse::always;
    static constexpr bool on_device = true;

    Vegas settings = {};

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

// The map after this many evaluations (used for training only), to save or to start other integrations from:
// Vegas{.training_iterations = 0, .map = train_map(...)}.
AdaptiveMap train_map(const Evaluator& g, std::uint64_t evaluations, const Vegas& settings = {},
                      std::uint64_t seed = 0);

} // namespace montelux
