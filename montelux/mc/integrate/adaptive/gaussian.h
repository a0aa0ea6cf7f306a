// Normal densities in several variables, and their fit to weighted points.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/points.h"
#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// A normal density with mean mu and covariance L L^T.
class Gaussian {
  public:
    // `cholesky`: lower triangle L, row by row, n x n.
    Gaussian(std::vector<double> mean, std::vector<double> cholesky);

    int dimensions() const { return static_cast<int>(mean_.size()); }
    std::span<const double> mean() const { return mean_; }
    std::span<const double> cholesky() const { return cholesky_; }
    std::span<const double> inverse() const { return inverse_; } // of L
    // x = mu + L z with z the normal quantiles of u; may lie outside the unit cube.
    void sample(const PointBatch& u, PointBuffer& x) const;
    // log p(x) at each point.
    void log_pdf(const PointBatch& x, std::span<double> result) const;
    // The density itself; 0 instead of numbers below the smallest normal ones, which are slow to compute.
    void pdf(const PointBatch& x, std::span<double> result) const;
    // (x - mu)^T Sigma^-1 (x - mu).
    double squared_distance(std::span<const double> x) const;
    double log_norm() const { return log_norm_; }
    // The same with L scaled.
    Gaussian widened(double factor) const;

    void save(StateWriter& state) const;
    static Gaussian load(StateReader& state);

  private:
    std::vector<double> mean_, cholesky_, inverse_; // inverse_: of L, lower triangle
    double log_norm_;
};

// Lower triangle L with L L^T = the symmetric matrix (n x n); empty where that is not positive definite.
std::vector<double> cholesky_factor(std::span<const double> matrix, int n);

struct Eigensystem {
    std::vector<double> values;  // n
    std::vector<double> vectors; // column k is the k-th, row by row, n x n
};
// Of a symmetric matrix, by Jacobi's rotations.
Eigensystem symmetric_eigensystem(std::vector<double> matrix, int n);

// Improves the components of a mixture of Gaussians by steps of expectation-maximisation on weighted points
// (Dempster, Laird, Rubin 1977; weighted as in population Monte Carlo, Cappe et al. 2008). Components that
// explain almost nothing are dropped; those with too few points for their covariance stay as they are. Returns false where
// `stop`, asked before each step, said so.
bool fit_gaussians(std::vector<Gaussian>& components, const PointBatch& x, std::span<const double> weights,
                   int steps, const std::function<bool()>& stop = {});

} // namespace montelux
