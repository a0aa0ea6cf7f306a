#include "montelux/mc/integrate/vegas/uniform_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"

namespace montelux {
namespace {

// Probability of a false alarm of the means, for all components together.
constexpr double significance = 1e-4;
// Standard errors by which a hidden part must change the result.
constexpr double hidden_errors = 3;
// A value |w| counts as hidden if it is this many times the largest of the map's own points.
constexpr double far_beyond = 4;

struct UniformSum {
    CovarianceMoments moments;
    double hidden = 0;
    NonFiniteCount non_finite;

    void merge(const UniformSum& later) {
        moments.merge(later.moments);
        hidden += later.hidden;
        non_finite.merge(later.non_finite);
    }
};

} // namespace

bool UniformCheck::run(const Problem& problem, DeviceValues* device, const AdaptiveMap& map,
                       const MapInsight& insight, double weight, std::uint64_t points, std::uint32_t stream,
                       std::span<const double> inverse_scale, NonFiniteCount& non_finite,
                       const CancelFlag* cancel) {
    const Evaluator& g = problem.evaluator;
    const int components = g.components();
    const auto sum = sum_blocks(
        points, device,
        [&](std::uint64_t first, std::uint64_t count) {
            device->draw_random(problem.seed, stream, first, count);
        },
        [&] {
            return UniformSum{CovarianceMoments(components, false), 0, {}};
        },
        [&](std::uint64_t first, std::uint64_t count, std::uint64_t number, UniformSum& to) {
            PointBuffer x(count, g.dimensions());
            fill_random(x, problem.seed, stream, first);
            MappedPoints mapped;
            if (device)
                mapped.evaluate_uniform(g, map, x, *device, number, inverse_scale, to.non_finite);
            else
                mapped.evaluate_uniform(g, map, x, inverse_scale, to.non_finite);
            std::vector<double> one(static_cast<std::size_t>(components));
            for (std::size_t i = 0; i < count; ++i) {
                const double inverse = 1 / mapped.jacobian()[i];
                for (int c = 0; c < components; ++c)
                    one[static_cast<std::size_t>(c)] = mapped.values(c)[i] * inverse;
                to.moments.add(one);
                if (mapped.squares()[i] > far_beyond * far_beyond * insight.largest_square)
                    to.hidden += std::sqrt(mapped.squares()[i]) * inverse;
            }
        },
        cancel);
    if (!sum) return false;
    moments_.merge(sum->moments);
    hidden_ += sum->hidden;
    non_finite.merge(sum->non_finite);
    const double share = weight / (weight_ + weight);
    for (std::size_t c = 0; c < expected_square_.size(); ++c)
        expected_square_[c] += share * (insight.uniform_square[c] - expected_square_[c]);
    size_ += share * (insight.size - size_);
    weight_ += weight;
    largest_square_ = std::max(largest_square_, insight.largest_square);
    return true;
}

void UniformCheck::warn(const std::vector<double>& value, const std::vector<double>& standard_error,
                        std::span<const double> inverse_scale, std::vector<std::string>& warnings) const {
    if (moments_.count() < 2) return;
    const double n = static_cast<double>(moments_.count());
    double worst = 0, error_square = 0;
    std::size_t where = 0;
    for (std::size_t c = 0; c < value.size(); ++c) {
        // The larger of the points' variance and the map's: few points miss peaks.
        const double expected = expected_square_[c] - value[c] * value[c];
        const double variance = std::max(moments_.variance(static_cast<int>(c)), expected) / n +
                                standard_error[c] * standard_error[c];
        const double difference = moments_.mean(static_cast<int>(c)) - value[c];
        const double z = variance > 0 ? difference / std::sqrt(variance) : 0;
        if (std::abs(z) > std::abs(worst)) {
            worst = z;
            where = c;
        }
        error_square += standard_error[c] * inverse_scale[c] * standard_error[c] * inverse_scale[c];
    }
    char text[256];
    if (2 * normal_cdf(-std::abs(worst)) * static_cast<double>(value.size()) < significance) {
        std::snprintf(text, sizeof text,
                      "uniform points that took no part in the estimate have a mean of %.6g for component "
                      "%zu, %.1f standard errors from its value",
                      moments_.mean(static_cast<int>(where)), where, worst);
        warnings.emplace_back(text);
    }
    const double hidden = hidden_ / n;
    // What the map may miss by chance: a region that a few of its points might have hit.
    const double chance = far_beyond * std::sqrt(largest_square_) / weight_;
    if (hidden > hidden_errors * std::sqrt(error_square) + chance && size_ > 0) {
        std::snprintf(text, sizeof text,
                      "uniform points found values where the adapted density hardly samples; they may be "
                      "%.2g %% of the integral of the absolute value",
                      100 * hidden / size_);
        warnings.emplace_back(text);
    }
}

void UniformCheck::save(StateWriter& state) const {
    montelux::save(state, moments_);
    state.put(expected_square_);
    for (double x : {size_, weight_, hidden_, largest_square_}) state.put(x);
}

void UniformCheck::load(StateReader& state) {
    montelux::load(state, moments_);
    std::vector<double> squares = state.get_doubles();
    if (squares.size() != expected_square_.size())
        throw Error("the saved state has another number of components");
    expected_square_ = std::move(squares);
    size_ = state.get_double();
    weight_ = state.get_double();
    hidden_ = state.get_double();
    largest_square_ = state.get_double();
}

} // namespace montelux
