// Closed-form families of one variable: pdf, cdf and quantile in double, and their n-dimensional product.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"

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

class UniformDistribution {
  public:
    explicit UniformDistribution(double lower = 0, double upper = 1) : lower_(lower), upper_(upper) {
        if (!(lower < upper && std::isfinite(upper - lower)))
            throw Error("UniformDistribution", "expected a finite interval that is not empty");
    }
    double lower() const { return lower_; }
    double upper() const { return upper_; }
    double pdf(double x) const { return x >= lower_ && x <= upper_ ? 1 / (upper_ - lower_) : 0; }
    double cdf(double x) const { return std::clamp((x - lower_) / (upper_ - lower_), 0.0, 1.0); }
    double quantile(double xi) const { return lower_ + xi * (upper_ - lower_); }

  private:
    double lower_, upper_;
};

// p = rate e^(-rate x) on [0, infinity): X = -ln(1 - xi) / rate.
class ExponentialDistribution {
  public:
    explicit ExponentialDistribution(double rate) : rate_(rate) {
        if (!(rate > 0 && std::isfinite(rate)))
            throw Error("ExponentialDistribution", "expected a finite rate above zero");
    }
    double lower() const { return 0; }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const { return x >= 0 ? rate_ * std::exp(-rate_ * x) : 0; }
    double cdf(double x) const { return x > 0 ? -std::expm1(-rate_ * x) : 0; }
    double quantile(double xi) const { return -std::log1p(-xi) / rate_; }

  private:
    double rate_;
};

// p proportional to x on [lower, upper), lower >= 0. On [0, 1): p = 2x, X = sqrt(xi); on [2, 4):
// P = (x^2 - 4) / 12, X = 2 sqrt(3 xi + 1).
class LinearDistribution {
  public:
    explicit LinearDistribution(double lower = 0, double upper = 1)
        : lower_(lower), upper_(upper), span_((upper - lower) * (upper + lower)) {
        if (!(lower >= 0 && lower < upper && std::isfinite(span_)))
            throw Error("LinearDistribution", "expected 0 <= lower < upper, both finite");
    }
    double lower() const { return lower_; }
    double upper() const { return upper_; }
    double pdf(double x) const { return x >= lower_ && x <= upper_ ? 2 * x / span_ : 0; }
    double cdf(double x) const {
        return x <= lower_ ? 0 : (x >= upper_ ? 1 : (x - lower_) * (x + lower_) / span_);
    }
    double quantile(double xi) const { return std::min(upper_, std::sqrt(lower_ * lower_ + xi * span_)); }

  private:
    double lower_, upper_, span_;
};

// p = cos x on [0, pi/2): X = asin xi.
class CosineDistribution {
  public:
    double lower() const { return 0; }
    double upper() const { return pi / 2; }
    double pdf(double x) const { return x >= 0 && x <= pi / 2 ? std::cos(x) : 0; }
    double cdf(double x) const { return x <= 0 ? 0 : (x >= pi / 2 ? 1 : std::sin(x)); }
    double quantile(double xi) const { return std::asin(xi); }
};

// p = 3 x^2 / 2 on [-1, 1]: X = cbrt(2 xi - 1).
class QuadraticDistribution {
  public:
    double lower() const { return -1; }
    double upper() const { return 1; }
    double pdf(double x) const { return x >= -1 && x <= 1 ? 1.5 * x * x : 0; }
    double cdf(double x) const { return x <= -1 ? 0 : (x >= 1 ? 1 : 0.5 * (x * x * x + 1)); }
    double quantile(double xi) const { return std::cbrt(2 * xi - 1); }
};

class NormalDistribution {
  public:
    explicit NormalDistribution(double mean = 0, double deviation = 1) : mean_(mean), deviation_(deviation) {
        if (!(deviation > 0 && std::isfinite(deviation) && std::isfinite(mean)))
            throw Error("NormalDistribution", "expected a finite mean and a finite deviation above zero");
    }
    double lower() const { return -std::numeric_limits<double>::infinity(); }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const {
        double z = (x - mean_) / deviation_;
        return std::exp(-0.5 * z * z) / (deviation_ * std::sqrt(2 * pi));
    }
    double cdf(double x) const { return normal_cdf((x - mean_) / deviation_); }
    // Minus infinity for xi = 0.
    double quantile(double xi) const { return mean_ + deviation_ * normal_quantile(xi); }

  private:
    double mean_, deviation_;
};

// Independent variables: the density is the product, per unit volume of the n-dimensional box.
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

} // namespace montelux
