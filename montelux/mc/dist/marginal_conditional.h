// Dependent variables in closed form: the marginal law of the first, then the law of the next given those.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "montelux/mc/dist/distribution_1d.h"

namespace montelux {

// The joint density p(x, y) = p(x) p(y | x), per unit area, and its sampling: X = P^-1(xi_0),
// Y = P^-1(xi_1 | X) (Rosenblatt 1952, "Remarks on a Multivariate Transformation", the inverse of his). The
// marginal is a Distribution1D, or a joint distribution of several variables (this class again, or a
// ProductDistribution), so that chains of any length can be built; `conditional` maps the point drawn so far
// (a double for one variable, a std::array for more) to the Distribution1D of the next. It is called for
// every sample, so the distribution that it makes should be one of the families rather than a table.
// Serves as a Technique of importance sampling (montelux/mc/integrate/techniques/technique.h).
template <typename Marginal, typename Conditional>
class MarginalConditional {
    static constexpr bool marginal_is_scalar = Distribution1D<Marginal>;
    static constexpr std::size_t marginal_dimensions() {
        if constexpr (marginal_is_scalar)
            return 1;
        else
            return Marginal::dimensions;
    }

  public:
    static constexpr std::size_t dimensions = marginal_dimensions() + 1;
    using Point = std::array<double, dimensions>;

    MarginalConditional(Marginal marginal, Conditional conditional)
        : marginal_(std::move(marginal)), conditional_(std::move(conditional)) {}

    const Marginal& marginal() const { return marginal_; }
    // The distribution of the last variable, given the others.
    auto conditional(const Point& x) const { return conditional_(head(x)); }

    // Zero wherever the marginal density is, without asking for the conditional there.
    double pdf(const Point& x) const {
        double marginal = marginal_.pdf(head(x));
        return marginal > 0 ? marginal * conditional(x).pdf(x.back()) : 0;
    }
    Point quantile(const Point& xi) const {
        return draw(marginal_.quantile(head(xi)), [&](const auto& d) { return d.quantile(xi.back()); });
    }
    // The same, finite for every xi in [0, 1)^n.
    Point sample(const Point& xi) const {
        auto last = [&](const auto& d) { return sample_by_inversion(d, xi.back()); };
        if constexpr (marginal_is_scalar)
            return draw(sample_by_inversion(marginal_, xi[0]), last);
        else
            return draw(marginal_.sample(head(xi)), last);
    }
    // The xi that `quantile` maps to x: each variable's distribution function given those before it.
    Point cdf(const Point& x) const { return joined(marginal_.cdf(head(x)), conditional(x).cdf(x.back())); }

  private:
    using Head = std::conditional_t<marginal_is_scalar, double, std::array<double, dimensions - 1>>;

    static Head head(const Point& x) {
        if constexpr (marginal_is_scalar) {
            return x[0];
        } else {
            Head first{};
            for (std::size_t i = 0; i + 1 < dimensions; ++i) first[i] = x[i];
            return first;
        }
    }
    static Point joined(const Head& first, double last) {
        Point x{};
        if constexpr (marginal_is_scalar)
            x[0] = first;
        else
            for (std::size_t i = 0; i + 1 < dimensions; ++i) x[i] = first[i];
        x.back() = last;
        return x;
    }
    template <typename Last>
    Point draw(const Head& first, const Last& last) const {
        return joined(first, last(conditional_(first)));
    }

    Marginal marginal_;
    Conditional conditional_;
};

} // namespace montelux
