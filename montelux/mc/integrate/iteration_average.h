// The mean over iterations of an adaptive estimate, and whether they agree.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/stats/covariance_moments.h"

namespace montelux {

struct SampleMoments;

// One iteration's estimate: values of the components and their covariances, row by row with the lower
// triangle alone filled (or variances alone).
struct IterationEstimate {
    std::vector<double> value, covariance;
    // Degrees of freedom of the variances; 0: practically known.
    int degrees_of_freedom = 0;
    // Of each component, where known: the largest share of one value in the variance.
    std::vector<double> largest_variance = {};
    double points = 0; // of the estimate; 0 where equal values prove that it is exact

    static IterationEstimate zero(int components, bool full_covariance);
    // Adds an independent part: the mean of samples of these moments, with its own covariance.
    void add_mean(const CovarianceMoments& samples);
    // The same with the largest share of one value, from the samples' extremes.
    void add_mean(const SampleMoments& samples);
};

// Iterations are weighted by numbers that are fixed before they run. (Weights by the variances that
// iterations find for themselves would be biased: low ones come with low values.) Agreement is tested by
// comparing each iteration with the mean of those before it. With such weights these differences are
// correlated, most of all where one early iteration makes up the mean and its error. The sum Q of their
// squares, in standard deviations, is therefore not chi-squared: its law is that of a chi-squared, scaled and
// shifted, with the mean, variance and skewness of Q (Imhof 1961, after Pearson).
class IterationAverage {
  public:
    IterationAverage() = default;
    IterationAverage(int components, bool full_covariance);

    void add(double weight, const IterationEstimate& iteration);

    int iterations() const { return iterations_; }
    // Fills values, errors, covariance, and Q with its p-value of the component whose iterations agree worst;
    // warns when the probability of such disagreement, with so many components, is below 1e-3.
    void tally(Tally& tally) const;

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    void compare(double weight, const IterationEstimate& iteration);
    double variance(int component) const;
    // The probability of a Q as large as this component's.
    double p_value(int component) const;

    bool full_ = true;
    int iterations_ = 0;
    double weight_ = 0;
    std::vector<double> value_;       // weighted mean
    std::vector<double> covariance_;  // sum of squared weights times covariances
    std::vector<double> chi_squared_; // Q
    std::vector<double> terms_;       // of Q
    // Traces of the square and the cube of the matrix of correlations of the differences.
    std::vector<double> square_trace_, cube_trace_;
    // With a later mean the difference d_j has the covariance a_j / W, where W is the sum of weights then. Sums
    // over j: of b_j = a_j^2 / var(d_j), and of a_j / (var(d_j) W_j) times the b_i before.
    std::vector<double> pairs_, triples_;
    std::vector<double> largest_; // squared weight times variance, of one value
    double points_ = 0;
    int degrees_of_freedom_ = 0;
};

} // namespace montelux
