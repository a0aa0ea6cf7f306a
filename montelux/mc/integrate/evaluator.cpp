#include "montelux/mc/integrate/evaluator.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {

void NonFiniteCount::merge(const NonFiniteCount& later) {
    if (count == 0) first_point = later.first_point;
    count += later.count;
    vanished += later.vanished;
}

Evaluator::Evaluator(Integrand integrand, Domain domain, NonFinitePolicy policy)
    : integrand_(std::move(integrand)), domain_(std::move(domain)), policy_(policy) {
    if (integrand_.components() < 1)
        throw Error("integrate", "expected an integrand with at least one component");
    const int fixed = integrand_.fixed_dimensions();
    if (fixed != 0 && fixed != domain_.dimensions())
        throw Error("integrate", "the integrand takes " +
                                     (fixed == 1 ? "one number" : std::to_string(fixed) + " numbers") +
                                     ", but the domain (" + domain_.description() + ") has " +
                                     std::to_string(domain_.dimensions()) + " dimensions" +
                                     (fixed == 1 ? "; expected f(std::span<const double>)" : ""));
}

void Evaluator::screen(const PointBatch& x, ValueBatch values, NonFiniteCount& non_finite,
                       std::vector<std::size_t>* where) const {
    for (int c = 0; c < values.components(); ++c) {
        // Zero times a finite number is zero, else NaN, which stays in a sum.
        double sum = 0;
        for (double v : values.component(c)) sum += v * 0;
        if (sum == 0) continue;
        for (std::size_t i = 0; i < values.count(); ++i) {
            if (std::isfinite(values(i, c))) continue;
            std::vector<double> point(static_cast<std::size_t>(x.dimensions()));
            x.gather(i, point.data());
            if (std::isnan(values(i, c)) && vanishes_before(point, c)) {
                ++non_finite.vanished;
                values(i, c) = 0;
                continue;
            }
            if (policy_ == NonFinitePolicy::throw_error) {
                std::ostringstream what;
                what.precision(17);
                what << "the integrand is ";
                if (std::isnan(values(i, c))) // whose sign says nothing
                    what << "nan at (";
                else
                    what << values(i, c) << " at (";
                for (std::size_t d = 0; d < point.size(); ++d) what << (d ? ", " : "") << point[d];
                what << ")";
                throw Error("integrate", what.str());
            }
            NonFiniteCount one{1, std::move(point)};
            non_finite.merge(one);
            if (where != nullptr) where->push_back(i);
            // One point counts once, and contributes to no component.
            for (int other = 0; other < values.components(); ++other) values(i, other) = 0;
        }
    }
}

bool Evaluator::vanishes_before(std::span<const double> x, int component) const {
    constexpr double falls = 0x1p-64;
    const std::span<const Range> ranges = domain_.ranges();
    std::vector<double> from(x.begin(), x.end()); // coordinates of finite ranges do not move
    double farthest = 0;
    for (std::size_t d = 0; d < ranges.size(); ++d) {
        const bool lower = std::isfinite(ranges[d].lower), upper = std::isfinite(ranges[d].upper);
        if (lower && upper) continue;
        from[d] = lower ? ranges[d].lower : upper ? ranges[d].upper : 0;
        farthest = std::max(farthest, std::abs(x[d] - from[d]));
    }
    if (!(farthest > 1) || !std::isfinite(farthest)) return false;
    PointBuffer point(1, static_cast<int>(x.size()));
    ValueBuffer f(1, components());
    const auto size = [&](int halvings) {
        for (std::size_t d = 0; d < x.size(); ++d)
            point(0, static_cast<int>(d)) = from[d] + std::ldexp(x[d] - from[d], -halvings);
        integrand_(point, f);
        return std::abs(std::as_const(f)(0, component));
    };
    int beyond = 0,
        last = std::ilogb(farthest) + 8; // halvings: the last NaN, and the first value that is none
    if (std::isnan(size(last))) return false;
    while (last - beyond > 1) {
        const int half = (beyond + last) / 2;
        (std::isnan(size(half)) ? beyond : last) = half;
    }
    const double value = size(last);
    return value == 0 || value < falls * size(last + 1);
}

void Evaluator::scale(ValueBatch g, const double* volume) const {
    const double constant = domain_.constant_volume();
    for (int c = 0; c < g.components(); ++c) {
        std::span<double> values = g.component(c);
        if (constant != 0)
            for (double& v : values) v *= constant;
        else // 0 * infinity: far out the integrand may underflow where the volume overflows
            for (std::size_t i = 0; i < values.size(); ++i)
                values[i] = values[i] == 0 ? 0 : values[i] * volume[i];
    }
}

void Evaluator::silence(const PointBatch& u, ValueBatch g) const {
    for (const NoiseBox& box : noise_) {
        std::span<double> values = g.component(box.component);
        for (std::size_t i = 0; i < values.size(); ++i) {
            bool inside = true;
            for (std::size_t d = 0; d < box.lower.size() && inside; ++d) {
                const double at = u(i, static_cast<int>(d));
                inside = at >= box.lower[d] && at <= box.upper[d];
            }
            if (inside) values[i] = 0;
        }
    }
}

void Evaluator::complete(ValueBatch g, const double* volume, const std::function<void(PointBuffer&)>& points,
                         NonFiniteCount& non_finite) const {
    if (!domain_.is_unit_cube()) scale(g, volume);
    double sum = 0; // zero unless a value is not finite
    for (int c = 0; c < g.components(); ++c)
        for (double v : g.component(c)) sum += v * 0;
    const bool finite = sum == 0;
    if (finite && noise_.empty() && !(largest_ && largest_->learns(g))) return;
    PointBuffer u(g.count(), domain_.uniforms());
    points(u);
    if (!finite) {
        PointBuffer x(g.count(), domain_.dimensions());
        std::vector<double> ignored(g.count(), 1.0);
        domain_.map(u, x, ignored);
        screen(x, g, non_finite);
    }
    silence(u, g);
    if (largest_) largest_->add(u, g);
}

void Evaluator::at_points(const PointBatch& x, ValueBatch f, NonFiniteCount& non_finite) const {
    integrand_(x, f);
    screen(x, f, non_finite);
}

void Evaluator::operator()(const PointBatch& u, ValueBatch g, NonFiniteCount& non_finite,
                           std::vector<std::size_t>* where) const {
    if (domain_.is_unit_cube()) {
        integrand_(u, g);
        screen(u, g, non_finite, where);
        silence(u, g);
        if (largest_) largest_->add(u, g);
        return;
    }
    thread_local PointBuffer x_buffer;
    thread_local std::vector<double> volume_buffer;
    // Taken, not borrowed: an integrand may itself integrate on this thread.
    PointBuffer x = std::move(x_buffer);
    std::vector<double> volume = std::move(volume_buffer);
    x.resize(u.count(), domain_.dimensions());
    volume.assign(u.count(), 1.0);
    domain_.map(u, x, volume);
    integrand_(x, g);
    scale(g, volume.data());
    screen(x, g, non_finite, where);
    silence(u, g);
    if (largest_) largest_->add(u, g);
    x_buffer = std::move(x);
    volume_buffer = std::move(volume);
}

} // namespace montelux
