#include "montelux/mc/integrate/chains/log_density_calls.h"

#include <cmath>
#include <limits>

namespace montelux {

bool LogDensityCalls::inside(std::span<const Range> box, std::span<const double> x) {
    for (std::size_t k = 0; k < x.size(); ++k)
        if (!(std::isfinite(x[k]) && x[k] >= box[k].lower && x[k] <= box[k].upper)) return false;
    return true;
}

void LogDensityCalls::operator()(std::span<const double> points, std::span<double> log_p) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const std::size_t d = dimensions();
    inside_.clear();
    for (std::size_t i = 0; i < log_p.size(); ++i) {
        log_p[i] = -infinite;
        if (inside(box_, points.subspan(i * d, d))) inside_.push_back(i);
    }
    if (inside_.empty()) return;
    x_.resize(inside_.size(), static_cast<int>(d));
    y_.resize(inside_.size(), 1);
    for (std::size_t i = 0; i < inside_.size(); ++i)
        for (std::size_t k = 0; k < d; ++k) x_(i, static_cast<int>(k)) = points[inside_[i] * d + k];
    (*log_density_)(x_, y_);
    evaluations_ += inside_.size();
    for (std::size_t i = 0; i < inside_.size(); ++i) {
        if (y_(i) < infinite)
            log_p[inside_[i]] = y_(i);
        else
            ++non_finite_;
    }
}

} // namespace montelux
