// The inversion method where the antiderivative is known, and perhaps its inverse too.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/inversion.h"
#include "montelux/mc/dist/inversion_checks.h"
#include "montelux/mc/dist/search.h"
#include "montelux/mc/math/increasing_root.h"

namespace montelux {

// Placeholder for an inverse that is not given.
struct NoInverse {};

// f >= 0 on [a, b] (either end may be infinite) and an antiderivative F, whose value at an infinite end is
// its limit there: c = F(b) - F(a), P = (F(x) - F(a)) / c, and X = F^-1(F(a) + xi c) with the inverse given,
// or a numerical root without. f and F need no normalisation. Tails keep the digits that F keeps next to
// F(a) and F(b). Satisfies TwoTailedDistribution1D.
template <typename Density, typename Antiderivative, typename Inverse = NoInverse>
class ClosedFormInversion : public SampledByInversion<ClosedFormInversion<Density, Antiderivative, Inverse>> {
  public:
    // Throws Error when the interval is empty, F(b) - F(a) is not a finite number above zero, f is negative
    // or NaN or F falls somewhere on 63 points that cut [a, b] into parts of equal probability, most slopes
    // of F there are not f, or F^-1(F(x)) is not x there.
    ClosedFormInversion(Density f, Antiderivative antiderivative, double a,
                        double b) requires std::same_as<Inverse, NoInverse>
        : ClosedFormInversion(std::move(f), std::move(antiderivative), NoInverse{}, a, b) {}
    ClosedFormInversion(Density f, Antiderivative antiderivative, Inverse inverse, double a, double b)
        : f_(std::move(f)), antiderivative_(std::move(antiderivative)), inverse_(std::move(inverse)), a_(a),
          b_(b) {
        require_interval(a, b);
        at_a_ = antiderivative_(a);
        at_b_ = antiderivative_(b);
        require_growth(a, at_a_, b, at_b_);
        build();
    }

    double lower() const { return a_; }
    double upper() const { return b_; }
    double integral() const { return at_b_ - at_a_; }
    double pdf(double x) const { return x >= a_ && x <= b_ ? f_(x) / integral() : 0; }
    double cdf(double x) const {
        if (!(x > a_)) return 0;
        return x < b_ ? std::clamp((antiderivative_(x) - at_a_) / integral(), 0.0, 1.0) : 1;
    }
    double cdf_complement(double x) const {
        if (!(x > a_)) return 1;
        return x < b_ ? std::clamp((at_b_ - antiderivative_(x)) / integral(), 0.0, 1.0) : 0;
    }
    double quantile(double xi) const {
        if (!(xi > 0)) return a_;
        return point(xi < 0.5 ? at_a_ + xi * integral() : at_b_ - (1 - xi) * integral());
    }
    double quantile_complement(double q) const {
        if (!(q > 0)) return b_;
        return point(q < 0.5 ? at_b_ - q * integral() : at_a_ + (1 - q) * integral());
    }

  private:
    static constexpr bool has_inverse = !std::same_as<Inverse, NoInverse>;
    static constexpr std::size_t parts = 64;

    double point(double target) const {
        if constexpr (has_inverse) {
            return std::clamp<double>(inverse_(target), a_, b_);
        } else {
            std::size_t i = find_last_not_above(knot_values_.data(), parts, target);
            return root(knots_[i], knots_[i + 1], target);
        }
    }
    // lo and hi may be infinite: then the finite side of the bracket is found by going out in growing steps.
    double root(double lo, double hi, double target) const {
        for (double step = 1; std::isinf(lo); step *= 4) {
            double x = (std::isfinite(hi) ? hi : 0) - step * scale(hi);
            if (!std::isfinite(x) || antiderivative_(x) <= target) lo = std::isfinite(x) ? x : largest(-1);
        }
        for (double step = 1; std::isinf(hi); step *= 4) {
            double x = lo + step * scale(lo);
            if (!std::isfinite(x) || antiderivative_(x) >= target) hi = std::isfinite(x) ? x : largest(1);
        }
        if (!(lo < hi)) return lo;
        return increasing_root(lo, hi, bracket_middle(lo, hi), [&](double x) {
            return std::pair<double, double>(antiderivative_(x) - target, f_(x));
        });
    }
    static double scale(double x) { return std::isfinite(x) ? std::max(1e-3, 0.1 * std::abs(x)) : 1; }
    static double largest(double sign) { return std::copysign(std::numeric_limits<double>::max(), sign); }

    void build() {
        // Where F falls again, no quantile leads: so points all over the interval are checked as well.
        for (std::size_t i = 1; i < parts; ++i) {
            double x = point_inside(a_, b_, static_cast<double>(i) / parts);
            require_rising(x, f_(x), antiderivative_(x), at_a_, at_b_);
        }
        knots_.front() = a_;
        knots_.back() = b_;
        knot_values_.front() = at_a_;
        knot_values_.back() = at_b_;
        std::size_t wrong_slopes = 0;
        double wrong_x = 0, wrong_slope = 0;
        for (std::size_t i = 1; i < parts; ++i) {
            double target = at_a_ + static_cast<double>(i) / parts * integral(), x;
            if constexpr (has_inverse)
                x = inverse_(target);
            else
                x = root(knots_[i - 1], b_, target);
            double value = antiderivative_(x), density = f_(x);
            require_antiderivative(x, density, value, target, integral());
            knots_[i] = std::max(x, knots_[i - 1]);
            knot_values_[i] = std::clamp(value, knot_values_[i - 1], at_b_);
            double h = 1e-4 * integral() / (parts * density), left = std::max(a_, x - h),
                   right = std::min(b_, x + h);
            double slope = (antiderivative_(right) - antiderivative_(left)) / (right - left);
            if (density > 0 && right > left && !(std::abs(slope - density) <= 0.01 * density)) {
                ++wrong_slopes;
                wrong_x = x;
                wrong_slope = slope;
            }
        }
        if (2 * wrong_slopes > parts) throw_wrong_slope(wrong_x, wrong_slope, f_(wrong_x));
    }

    Density f_;
    Antiderivative antiderivative_;
    Inverse inverse_;
    double a_, b_, at_a_ = 0, at_b_ = 0;
    std::array<double, parts + 1> knots_{}, knot_values_{}; // x at equal steps of P, and F there
};

// The recipe in one word: X with density proportional to f on [a, b], from f alone,
template <typename F>
NumericalInversion<F> inversion(F f, double a, double b, const InversionOptions& options = {}) {
    return NumericalInversion<F>(std::move(f), a, b, options);
}
// from f and an antiderivative,
template <typename Density, std::invocable<double> Antiderivative>
ClosedFormInversion<Density, Antiderivative> inversion(Density f, Antiderivative antiderivative, double a,
                                                       double b) {
    return {std::move(f), std::move(antiderivative), a, b};
}
// or from f, an antiderivative and that one's inverse.
template <typename Density, std::invocable<double> Antiderivative, std::invocable<double> Inverse>
ClosedFormInversion<Density, Antiderivative, Inverse> inversion(Density f, Antiderivative antiderivative,
                                                                Inverse inverse, double a, double b) {
    return {std::move(f), std::move(antiderivative), std::move(inverse), a, b};
}

} // namespace montelux
