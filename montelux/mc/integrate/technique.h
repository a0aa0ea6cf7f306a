// A sampling technique: uniform numbers to a point, and the density of that point.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "montelux/mc/dist/families.h"

namespace montelux {

// `sample` maps `dimensions` uniform numbers in [0, 1) to a point x that follows `pdf`, in any measure that
// the integral is taken in.
template <typename S>
concept SamplingTechnique = requires(const S& s, const std::array<double, S::dimensions>& xi) {
    { s.pdf(s.sample(xi)) } -> std::convertible_to<double>;
};

// From a pair of functions.
template <std::size_t D, typename Sample, typename Pdf>
struct FunctionTechnique {
    static constexpr std::size_t dimensions = D;
    Sample sample_function;
    Pdf pdf_function;

    auto sample(const std::array<double, D>& xi) const { return sample_function(xi); }
    template <typename X>
    double pdf(const X& x) const {
        return pdf_function(x);
    }
};
template <std::size_t D, typename Sample, typename Pdf>
FunctionTechnique<D, Sample, Pdf> make_technique(Sample sample, Pdf pdf) {
    return {std::move(sample), std::move(pdf)};
}

// From a distribution of one variable, by inversion: X = P^-1(xi).
template <Distribution1D D>
struct InversionTechnique {
    static constexpr std::size_t dimensions = 1;
    D distribution;

    double sample(const std::array<double, 1>& xi) const { return distribution.quantile(xi[0]); }
    double pdf(double x) const { return distribution.pdf(x); }
};

// From a product of distributions.
template <typename... Ds>
struct ProductTechnique {
    static constexpr std::size_t dimensions = sizeof...(Ds);
    ProductDistribution<Ds...> distribution;

    std::array<double, dimensions> sample(const std::array<double, dimensions>& xi) const {
        return distribution.quantile(xi);
    }
    double pdf(const std::array<double, dimensions>& x) const { return distribution.pdf(x); }
};

template <Distribution1D D>
InversionTechnique<D> as_technique(D distribution) {
    return {std::move(distribution)};
}
template <typename... Ds>
ProductTechnique<Ds...> as_technique(ProductDistribution<Ds...> distribution) {
    return {std::move(distribution)};
}
template <SamplingTechnique S>
S as_technique(S technique) {
    return technique;
}

} // namespace montelux
