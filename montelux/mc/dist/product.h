// Independent variables: the product of distributions, their number fixed or known at run time.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "montelux/mc/dist/distribution.h"
#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/math/error.h"

namespace montelux {

// The density is the product, per unit volume of the n-dimensional box.
template <Distribution1D... Ds>
class ProductDistribution {
  public:
    static constexpr std::size_t dimensions = sizeof...(Ds);
    using Point = std::array<double, dimensions>;

    explicit ProductDistribution(Ds... factors) : factors_(std::move(factors)...) {}

    double pdf(const Point& x) const {
        return each([&](const auto&... d) {
            std::size_t i = 0;
            double p = 1;
            ((p *= d.pdf(x[i++])), ...);
            return p;
        });
    }
    // Componentwise; quantile(xi) with xi uniform in the unit cube follows the density.
    Point quantile(const Point& xi) const {
        return each([&](const auto&... d) {
            std::size_t i = 0;
            return Point{d.quantile(xi[i++])...};
        });
    }
    // The same, finite for every xi in [0, 1)^n.
    Point sample(const Point& xi) const {
        return each([&](const auto&... d) {
            std::size_t i = 0;
            return Point{sample_by_inversion(d, xi[i++])...};
        });
    }
    Point cdf(const Point& x) const {
        return each([&](const auto&... d) {
            std::size_t i = 0;
            return Point{d.cdf(x[i++])...};
        });
    }

  private:
    template <typename F>
    auto each(F f) const {
        return std::apply(f, factors_);
    }
    std::tuple<Ds...> factors_;
};

// The same with factors of one type, their number known at run time; with Distribution as that type
// each may be of another family. Points and uniform numbers are spans of dimensions() doubles; `x` and `xi`
// may be the same memory.
template <Distribution1D D = Distribution>
class RuntimeProduct {
  public:
    // Throws Error on an empty list.
    explicit RuntimeProduct(std::vector<D> factors) : factors_(std::move(factors)) {
        if (factors_.empty()) throw Error("RuntimeProduct", "expected at least one factor, found none");
    }

    std::size_t dimensions() const { return factors_.size(); }
    const D& factor(std::size_t i) const { return factors_[i]; }

    double pdf(std::span<const double> x) const {
        double p = 1;
        for (std::size_t i = 0; i < dimensions(); ++i) p *= factors_[i].pdf(x[i]);
        return p;
    }
    void quantile(std::span<const double> xi, std::span<double> x) const {
        for (std::size_t i = 0; i < dimensions(); ++i) x[i] = factors_[i].quantile(xi[i]);
    }
    void sample(std::span<const double> xi, std::span<double> x) const {
        for (std::size_t i = 0; i < dimensions(); ++i) x[i] = sample_by_inversion(factors_[i], xi[i]);
    }
    void cdf(std::span<const double> x, std::span<double> xi) const {
        for (std::size_t i = 0; i < dimensions(); ++i) xi[i] = factors_[i].cdf(x[i]);
    }

  private:
    std::vector<D> factors_;
};

} // namespace montelux
