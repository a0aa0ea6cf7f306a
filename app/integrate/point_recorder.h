// The first points at which an integrand is evaluated, with its values, for a CSV file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "montelux/mc/integrate/points.h"

namespace montelux::app {

// Belongs to one thread: the order of the points is that of the calls.
class PointRecorder {
  public:
    explicit PointRecorder(std::uint64_t limit) : limit_(limit) {}

    void add(const PointBatch& x, ValueBatch y);
    // One line of names, then a line a point: coordinates, values. Throws Error.
    void write(const std::string& path, const std::vector<std::string>& variables,
               const std::vector<std::string>& formulas) const;
    std::uint64_t count() const { return count_; }

  private:
    std::uint64_t limit_, count_ = 0;
    std::vector<double> rows_;
};

} // namespace montelux::app
