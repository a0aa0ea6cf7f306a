// Concepts of a distribution of one variable: pdf, cdf and quantile in double; tails, and sampling by
// inversion.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <random>

namespace montelux {

// A density per unit length on [lower, upper] (the ends may be infinite), its integral from `lower`, and
// the inverse of that: X = quantile(xi) with xi uniform in [0, 1) follows the density.
template <typename D>
concept Distribution1D = requires(const D& d, double x) {
    { d.lower() } -> std::convertible_to<double>;
    { d.upper() } -> std::convertible_to<double>;
    { d.pdf(x) } -> std::convertible_to<double>;
    { d.cdf(x) } -> std::convertible_to<double>;
    { d.quantile(x) } -> std::convertible_to<double>;
};

// One that keeps its digits in the upper tail too: cdf_complement(x) = 1 - cdf(x), the probability above x
// (the survival function), and its inverse.
template <typename D>
concept TwoTailedDistribution1D = Distribution1D<D> && requires(const D& d, double x) {
    { d.cdf_complement(x) } -> std::convertible_to<double>;
    { d.quantile_complement(x) } -> std::convertible_to<double>;
};

// The same of any distribution; by subtraction from 1 where it has no better way.
template <Distribution1D D>
double cdf_complement(const D& d, double x) {
    if constexpr (TwoTailedDistribution1D<D>)
        return d.cdf_complement(x);
    else
        return 1 - d.cdf(x);
}
template <Distribution1D D>
double quantile_complement(const D& d, double q) {
    if constexpr (TwoTailedDistribution1D<D>)
        return d.quantile_complement(q);
    else
        return d.quantile(1 - q);
}

// X = quantile(xi), kept finite where a support is infinite: xi = 0, which a generator of 53 bits gives once
// in 2^53 numbers, then stands for the middle of its cell.
template <Distribution1D D>
double sample_by_inversion(const D& d, double xi) {
    double x = d.quantile(xi);
    return std::isfinite(x) ? x : d.quantile(std::clamp(xi, 0x1p-54, 1 - 0x1p-53));
}

// Base of a distribution D that is sampled by its quantile.
template <typename D>
class SampledByInversion {
  public:
    // xi uniform in [0, 1); finite for each of them, and increasing in xi, so that the order of stratified
    // and quasi-random numbers is kept.
    double sample(double xi) const { return sample_by_inversion(static_cast<const D&>(*this), xi); }
    // As the distributions of the standard library: one value from an engine such as std::mt19937_64.
    template <std::uniform_random_bit_generator Engine>
    double operator()(Engine& engine) const {
        double xi = std::generate_canonical<double, 53>(engine);
        return sample(xi);
    }
};

} // namespace montelux
