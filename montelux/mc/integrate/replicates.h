// Sums of independent randomisations of one point set, whose spread is the error of their mean.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/mc/integrate/sampling.h"

namespace montelux {

// For each of R replicates the sums of its values so far, all over the same number of points. The mean over
// replicates is the estimate; its error comes from their spread and follows Student's law with R - 1 degrees
// of freedom (Owen 2013, "Monte Carlo theory, methods and examples", section 17).
class ReplicateSums {
  public:
    ReplicateSums() = default;
    ReplicateSums(int replicates, int components)
        : components_(components),
          sums_(static_cast<std::size_t>(replicates) * static_cast<std::size_t>(components)) {}

    int replicates() const { return components_ == 0 ? 0 : static_cast<int>(sums_.size()) / components_; }
    int components() const { return components_; }
    double& sum(int replicate, int component) {
        return sums_[static_cast<std::size_t>(replicate) * components_ + component];
    }
    double sum(int replicate, int component) const {
        return sums_[static_cast<std::size_t>(replicate) * components_ + component];
    }
    void merge(const ReplicateSums& other) {
        for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
    }
    // Moments, over replicates, of sum / points.
    CovarianceMoments moments(std::uint64_t points, bool full) const;
    const std::vector<double>& all() const { return sums_; }
    void restore(std::vector<double> sums) { sums_ = std::move(sums); }

  private:
    int components_ = 0;
    std::vector<double> sums_;
};

} // namespace montelux
