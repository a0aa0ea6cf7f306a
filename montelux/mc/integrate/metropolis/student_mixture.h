// A multivariate Student density on the unit cube, mixed with a uniform one, as importance density.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/state_archive.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/stats/covariance_moments.h"

namespace montelux {

// The lower triangular L with L L^T = covariance (row by row), after a small multiple of the identity was
// added where the matrix is singular.
std::vector<double> cholesky_factor(std::vector<double> covariance, std::size_t dimensions);

// Nine parts Student's density with 4 degrees of freedom about `mean`, with shape L L^T, one part uniform on
// the cube. The Student part reaches beyond the cube: points there have the integrand 0.
class StudentMixture {
  public:
    StudentMixture() = default;
    // Mean and covariance of a sample; must hold covariances and two points at least.
    explicit StudentMixture(const CovarianceMoments& moments);

    // Fills x; false where it lies outside of the cube.
    bool sample(PhiloxStream& numbers, std::span<double> x) const;
    // Per unit volume, at a point of the cube.
    double density(std::span<const double> x) const;
    // L, row by row.
    const std::vector<double>& factor() const { return factor_; }

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    void normalise();

    std::vector<double> mean_, factor_;
    double log_constant_ = 0;
};

} // namespace montelux
