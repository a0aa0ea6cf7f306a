#include "montelux/mc/integrate/vegas/mapped_points.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/lane_sum.h"

namespace montelux {

void MappedPoints::evaluate(const Evaluator& g, const AdaptiveMap& map, const PointBatch& y,
                            std::span<const double> inverse_scale, NonFiniteCount& non_finite) {
    x_.resize(y.count(), y.dimensions());
    values_.resize(y.count(), g.components());
    jacobian_.assign(y.count(), 1.0);
    map.map(y, x_, jacobian_);
    g(x_, values_, non_finite);
    finish(inverse_scale);
}

void MappedPoints::evaluate(const Evaluator& g, const AdaptiveMap& map, const DeviceValues& device,
                            std::uint64_t number, std::size_t n,
                            const std::function<void(PointBuffer&)>& uniform,
                            std::span<const double> inverse_scale, NonFiniteCount& non_finite) {
    values_.resize(n, g.components());
    const std::span<const double> jacobian = device.jacobian(number, n);
    jacobian_.assign(jacobian.begin(), jacobian.end());
    const auto fill = [&](PointBuffer& x) {
        PointBuffer y(n, x.dimensions());
        uniform(y);
        std::vector<double> ignored(n, 1.0);
        map.map(y, x, ignored);
    };
    device.read(number, values_, fill, non_finite);
    finish(inverse_scale);
}

void MappedPoints::evaluate_uniform(const Evaluator& g, const AdaptiveMap& map, const PointBatch& x,
                                    const DeviceValues& device, std::uint64_t number,
                                    std::span<const double> inverse_scale, NonFiniteCount& non_finite) {
    x_.resize(x.count(), x.dimensions());
    values_.resize(x.count(), g.components());
    jacobian_.assign(x.count(), 1.0);
    map.inverse(x, x_, jacobian_);
    const auto fill = [&](PointBuffer& u) {
        for (int d = 0; d < x.dimensions(); ++d) std::ranges::copy(x.coordinate(d), u.coordinate(d).begin());
    };
    device.read(number, values_, fill, non_finite);
    finish(inverse_scale);
}

void MappedPoints::evaluate_uniform(const Evaluator& g, const AdaptiveMap& map, const PointBatch& x,
                                    std::span<const double> inverse_scale, NonFiniteCount& non_finite) {
    x_.resize(x.count(), x.dimensions());
    values_.resize(x.count(), g.components());
    jacobian_.assign(x.count(), 1.0);
    map.inverse(x, x_, jacobian_); // of which only the Jacobian is used
    g(x, values_, non_finite);
    finish(inverse_scale);
}

void MappedPoints::finish(std::span<const double> inverse_scale) {
    squares_.assign(jacobian_.size(), 0.0);
    for (int c = 0; c < values_.components(); ++c) {
        std::span<double> w = values_.component(c);
        const double scale = inverse_scale[static_cast<std::size_t>(c)];
        for (std::size_t i = 0; i < w.size(); ++i) {
            w[i] *= jacobian_[i];
            squares_[i] += (w[i] * scale) * (w[i] * scale);
        }
    }
}

void MapInsight::add(const MappedPoints& points, std::span<const double> share) {
    const std::size_t n = points.count();
    const double* a = share.data();
    const double* jacobian = points.jacobian().data();
    for (std::size_t c = 0; c < square.size(); ++c) {
        const double* w = points.values(static_cast<int>(c)).data();
        square[c] += lane_sum(n, [&](std::size_t i) { return a[i] * (w[i] * w[i]); });
        uniform_square[c] += lane_sum(n, [&](std::size_t i) { return a[i] * (w[i] * w[i]) / jacobian[i]; });
        absolute[c] += lane_sum(n, [&](std::size_t i) { return a[i] * std::abs(w[i]); });
    }
    const double* squares = points.squares().data();
    size += lane_sum(n, [&](std::size_t i) { return a[i] * std::sqrt(squares[i]); });
    largest_square = std::max(largest_square, lane_max(n, [&](std::size_t i) { return squares[i]; }));
}

void MapInsight::merge(const MapInsight& later) {
    for (std::size_t c = 0; c < square.size(); ++c) {
        square[c] += later.square[c];
        uniform_square[c] += later.uniform_square[c];
        absolute[c] += later.absolute[c];
    }
    size += later.size;
    largest_square = std::max(largest_square, later.largest_square);
    tail.merge(later.tail);
    tail_values += later.tail_values;
    training.merge(later.training);
    non_finite.merge(later.non_finite);
}

} // namespace montelux
