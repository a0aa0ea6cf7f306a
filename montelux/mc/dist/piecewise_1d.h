// Tabulated densities on an interval: piecewise constant and piecewise linear, sampled by exact inversion.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/dist/discrete.h"

namespace montelux {

// A point, its density (per unit of x), and the piece that it lies in.
template <std::floating_point T = float>
struct PiecewiseSample1D {
    T x = 0;
    T pdf = 0;
    std::uint32_t piece = 0;
};

// n pieces of equal width on [lower, upper); the density on piece i is proportional to values[i].
// Pieces of value zero are never drawn. Values that are all zero give the uniform density, with
// integral() 0. Throws Error on no values, on a negative or non-finite one, and unless lower < upper.
class PiecewiseConstant1D {
  public:
    explicit PiecewiseConstant1D(std::span<const double> values, double lower = 0, double upper = 1);
    explicit PiecewiseConstant1D(std::span<const float> values, double lower = 0, double upper = 1);

    std::size_t size() const { return cdf_.size() - 1; }
    double lower() const { return lower_; }
    double upper() const { return upper_; }
    // Of the tabulated function over [lower, upper].
    double integral() const { return integral_; }

    template <std::floating_point T>
    PiecewiseSample1D<T> sample(T u) const {
        double v = static_cast<double>(u);
        std::size_t i = find_last_not_above(cdf_.data(), size(), v);
        while (i > 0 && cdf_[i] == cdf_[i + 1]) --i; // only for u >= 1, outside the contract
        double p = cdf_[i + 1] - cdf_[i];
        double t = std::min((v - cdf_[i]) / p, 1.0);
        double x = lower_ + (static_cast<double>(i) + t) * width_;
        return {keep_below(static_cast<T>(x), static_cast<T>(upper_)), static_cast<T>(p / width_),
                static_cast<std::uint32_t>(i)};
    }
    // Zero outside [lower, upper].
    template <std::floating_point T>
    T pdf(T x) const {
        double s = (static_cast<double>(x) - lower_) / width_;
        if (!(s >= 0 && s <= static_cast<double>(size()))) return 0;
        std::size_t i = std::min(static_cast<std::size_t>(s), size() - 1);
        return static_cast<T>((cdf_[i + 1] - cdf_[i]) / width_);
    }
    // The cumulative distribution and its inverse, so that this is a Distribution1D.
    double cdf(double x) const { return x <= lower_ ? 0 : (x >= upper_ ? 1 : *inverse(x)); }
    double quantile(double xi) const { return sample(xi).x; }
    // The u that `sample` maps to x: the cumulative distribution. Empty outside [lower, upper].
    template <std::floating_point T>
    std::optional<T> inverse(T x) const {
        double s = (static_cast<double>(x) - lower_) / width_;
        if (!(s >= 0 && s <= static_cast<double>(size()))) return std::nullopt;
        std::size_t i = std::min(static_cast<std::size_t>(s), size() - 1);
        return static_cast<T>(cdf_[i] + (s - static_cast<double>(i)) * (cdf_[i + 1] - cdf_[i]));
    }

  private:
    template <typename T>
    void build(std::span<const T> values);

    std::vector<double> cdf_; // at the edges of the pieces, from 0 to exactly 1
    double lower_, upper_, width_ = 0, integral_ = 0;
};

// Linear between the nodes (x_i, f_i). Same rules as above; at least two nodes, in strictly increasing x.
class PiecewiseLinear1D {
  public:
    PiecewiseLinear1D(std::span<const double> x, std::span<const double> f);
    // Nodes at equal distances from lower to upper.
    explicit PiecewiseLinear1D(std::span<const double> f, double lower = 0, double upper = 1);

    std::size_t size() const { return x_.size() - 1; } // number of pieces
    double lower() const { return x_.front(); }
    double upper() const { return x_.back(); }
    double integral() const { return integral_; }

    template <std::floating_point T>
    PiecewiseSample1D<T> sample(T u) const {
        Inverted s = invert_cdf(static_cast<double>(u));
        return {keep_below(static_cast<T>(s.x), static_cast<T>(upper())), static_cast<T>(s.pdf),
                static_cast<std::uint32_t>(s.piece)};
    }
    template <std::floating_point T>
    T pdf(T x) const {
        return static_cast<T>(density(static_cast<double>(x)));
    }
    // The cumulative distribution and its inverse, so that this is a Distribution1D.
    double cdf(double x) const { return x <= lower() ? 0 : (x >= upper() ? 1 : integral_to(x)); }
    double quantile(double xi) const { return sample(xi).x; }
    template <std::floating_point T>
    std::optional<T> inverse(T x) const {
        double v = static_cast<double>(x);
        if (!(v >= lower() && v <= upper())) return std::nullopt;
        return static_cast<T>(integral_to(v));
    }

  private:
    struct Inverted {
        double x, pdf;
        std::size_t piece;
    };
    void build();
    Inverted invert_cdf(double u) const;
    double density(double x) const;
    double integral_to(double x) const;

    std::vector<double> x_, density_, cdf_; // at the nodes; density_ is normalised
    double integral_ = 0;
};

} // namespace montelux
