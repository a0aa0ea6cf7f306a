// LogDensityCalls: a log density on a box for one chain or ensemble, called for many points at once, with its counts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/integrand.h"

namespace montelux {

// Copies have buffers of their own; one object belongs to one thread at a time.
class LogDensityCalls {
  public:
    LogDensityCalls(const Integrand& log_density, std::span<const Range> box)
        : log_density_(&log_density), box_(box) {}

    std::size_t dimensions() const { return box_.size(); }
    // log p at points given one after the other. Outside of the box, and at infinity, it is -infinity, without a call;
    // NaN and +infinity become -infinity and are counted.
    void operator()(std::span<const double> points, std::span<double> log_p);
    // Is a point one of the box, with finite coordinates?
    static bool inside(std::span<const Range> box, std::span<const double> x);

    std::uint64_t evaluations() const { return evaluations_; }
    std::uint64_t non_finite() const { return non_finite_; }

  private:
    const Integrand* log_density_;
    std::span<const Range> box_;
    PointBuffer x_;
    ValueBuffer y_;
    std::vector<std::size_t> inside_;
    std::uint64_t evaluations_ = 0, non_finite_ = 0;
};

} // namespace montelux
