#include "montelux/mc/integrate/integrand_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Exponents of the largest value relative to the scale. Squares, their sums over 2^60 samples and weights f /
// p stay finite below the upper one; relative errors of 1e-16 stay above the smallest squares above the lower
// one.
constexpr double lowest = -200, highest = 460;
// Exponent of the largest value that is kept, change of volume included. Larger ones void the estimate but
// stay finite, since the integrand is not at fault.
constexpr double largest_kept = 900;
constexpr double nothing = -std::numeric_limits<double>::infinity();

double times_power_of_two(double x, double exponent) {
    // Far beyond the range of doubles the result is zero or infinite in any case.
    return std::ldexp(x, static_cast<int>(std::clamp(exponent, -5000.0, 5000.0)));
}

} // namespace

IntegrandScale::IntegrandScale(int components, IntegrandForm form, bool common, double volume_exponent)
    : form_(form), common_(common), volume_exponent_(volume_exponent),
      limit_(times_power_of_two(1, std::min(largest_kept - volume_exponent, 1000.0))),
      exponents_(static_cast<std::size_t>(components), 0.0),
      largest_(std::make_unique<std::atomic<double>[]>(exponents_.size())) {
    for (std::size_t c = 0; c < exponents_.size(); ++c) largest_[c] = nothing;
    if (volume_exponent < lowest / 2 || volume_exponent > highest / 2)
        std::ranges::fill(exponents_, std::round(volume_exponent));
}

double IntegrandScale::unscaled(double x, std::size_t component) const {
    return times_power_of_two(x, exponents_[component]);
}

double IntegrandScale::scaled(double x) const { return times_power_of_two(x, -exponents_[0]); }

double IntegrandScale::unscaled_product(double x, std::size_t a, std::size_t b) const {
    return times_power_of_two(x, exponents_[a] + exponents_[b]);
}

void IntegrandScale::apply(std::size_t component, std::span<double> values) {
    const double k = exponents_[component];
    double largest = nothing;
    if (form_ == IntegrandForm::value) {
        for (double v : values) {
            const double size = std::abs(v);
            largest = size > largest && size < std::numeric_limits<double>::infinity() ? size : largest;
        }
        if (largest > nothing && times_power_of_two(largest, -k) > limit_) {
            for (double& v : values)
                if (std::isfinite(v)) v = std::clamp(times_power_of_two(v, -k), -limit_, limit_);
        } else if (k != 0) {
            // Two factors, each a double, reach from one end of the range to the other.
            const double half = std::trunc(k / 2);
            const double first = times_power_of_two(1, -half), second = times_power_of_two(1, half - k);
            for (double& v : values) v = v * first * second;
        }
    } else {
        const double shift = k * std::numbers::ln2;
        for (double& v : values) {
            if (v < std::numeric_limits<double>::infinity()) {
                largest = std::max(largest, v);
                v = std::min(std::exp(v - shift), limit_);
            }
        }
    }
    double known = largest_[component].load(std::memory_order_relaxed);
    while (largest > known &&
           !largest_[component].compare_exchange_weak(known, largest, std::memory_order_relaxed)) {
    }
}

void IntegrandScale::settle(const ValueBatch& values) {
    if (settled_.load(std::memory_order_acquire)) return;
    const std::lock_guard lock(settling_);
    if (settled_.load(std::memory_order_relaxed)) return;
    for (int c = 0; c < values.components(); ++c) {
        double largest = nothing;
        for (double v : values.component(c)) {
            const double size = form_ == IntegrandForm::value ? std::abs(v) : v;
            if (size < std::numeric_limits<double>::infinity()) largest = std::max(largest, size);
        }
        if (largest > (form_ == IntegrandForm::value ? 0 : nothing))
            largest_[static_cast<std::size_t>(c)].store(largest);
    }
    const bool seen = std::ranges::any_of(std::span(largest_.get(), exponents_.size()), [&](const auto& l) {
        return l.load() > (form_ == IntegrandForm::value ? 0 : nothing);
    });
    if (!seen) return;
    adjust();
    settled_.store(true, std::memory_order_release);
}

std::vector<double> IntegrandScale::largest() const {
    std::vector<double> all;
    for (std::size_t c = 0; c < exponents_.size(); ++c) all.push_back(largest_[c].load());
    return all;
}

void IntegrandScale::ignore_spikes() {
    std::ranges::fill(exponents_, 0.0);
    for (std::size_t c = 0; c < exponents_.size(); ++c) largest_[c].store(nothing);
    settled_ = true;
}

void IntegrandScale::restore_largest(const std::vector<double>& largest) {
    for (std::size_t c = 0; c < exponents_.size(); ++c) largest_[c].store(largest[c]);
}

bool IntegrandScale::adjust() {
    std::vector<double> sizes(exponents_.size(), nothing);
    for (std::size_t c = 0; c < sizes.size(); ++c) {
        const double largest = largest_[c].load(std::memory_order_relaxed);
        if (form_ == IntegrandForm::logarithm)
            sizes[c] = largest > nothing ? largest / std::numbers::ln2 + volume_exponent_ : nothing;
        else if (largest > 0)
            sizes[c] = std::log2(largest) + volume_exponent_;
    }
    if (common_) std::ranges::fill(sizes, *std::ranges::max_element(sizes));
    bool moved = false;
    for (std::size_t c = 0; c < sizes.size(); ++c) {
        if (sizes[c] == nothing) continue;
        const double relative = sizes[c] - exponents_[c];
        if (relative >= lowest && relative <= highest) continue;
        exponents_[c] = std::round(sizes[c]);
        moved = true;
    }
    return moved;
}

void IntegrandScale::save(StateWriter& state) const {
    state.put(exponents_);
    for (std::size_t c = 0; c < exponents_.size(); ++c) state.put(largest_[c].load());
}

void IntegrandScale::load(StateReader& state) {
    std::vector<double> exponents = state.get_doubles();
    if (exponents.size() != exponents_.size())
        throw Error("the saved state has another number of components");
    exponents_ = std::move(exponents);
    for (std::size_t c = 0; c < exponents_.size(); ++c) largest_[c] = state.get_double();
    settled_ = true;
}

Integrand scaled(const Integrand& f, IntegrandScale& scale) {
    const auto apply = [&scale](ValueBatch y) {
        scale.settle(y);
        for (int c = 0; c < y.components(); ++c) scale.apply(static_cast<std::size_t>(c), y.component(c));
    };
    OnDevice device = f.on_device();
    device.after.emplace_back(apply);
    Integrand::BatchFunction rounding;
    if (f.rounding())
        rounding = [&scale, twice = f.rounding()](const PointBatch& x, ValueBatch y) {
            twice(x, y);
            for (int c = 0; c < y.components(); ++c)
                scale.apply(static_cast<std::size_t>(c / 2), y.component(c));
        };
    return f
        .with_function([f, apply](const PointBatch& x, ValueBatch y) {
            f(x, y);
            apply(y);
        })
        .with_rounding(std::move(rounding))
        .with_device(std::move(device));
}

} // namespace montelux
