// A mixture: each value comes from one of several distributions, chosen by their weights.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "montelux/mc/dist/discrete.h"
#include "montelux/mc/dist/distribution.h"
#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/increasing_root.h"

namespace montelux {

// p(x) = sum of w_i p_i(x) with weights normalised to 1. With Distribution as the component type, components
// may be of different families.
template <Distribution1D D = Distribution>
class Mixture {
  public:
    // Throws Error unless there are as many weights as components, at least one, none negative or not finite,
    // not all zero.
    Mixture(std::span<const double> weights, std::vector<D> components)
        : weights_(weights), components_(std::move(components)) {
        if (weights.size() != components_.size())
            throw Error("Mixture", "expected as many weights as components");
        if (!(weights_.weight_sum() > 0)) throw Error("Mixture", "expected a weight above zero");
    }
    Mixture(std::initializer_list<double> weights, std::vector<D> components)
        : Mixture(std::span<const double>(weights.begin(), weights.size()), std::move(components)) {}

    std::size_t size() const { return components_.size(); }
    double weight(std::size_t i) const { return weights_.probability(i); }
    const D& component(std::size_t i) const { return components_[i]; }

    double lower() const {
        return least([](const D& d) { return d.lower(); });
    }
    double upper() const {
        return greatest([](const D& d) { return d.upper(); });
    }
    double pdf(double x) const {
        return sum([&](const D& d) { return d.pdf(x); });
    }
    double cdf(double x) const {
        return sum([&](const D& d) { return d.cdf(x); });
    }
    double cdf_complement(double x) const {
        return sum([&](const D& d) { return montelux::cdf_complement(d, x); });
    }
    // By a numerical root between the least and the greatest quantile of the components, which costs some ten
    // values of cdf and pdf. Where the components leave a gap, any point of it may be given.
    double quantile(double xi) const {
        if (xi > 0.5) return quantile_complement(1 - xi);
        auto component_quantile = [&](const D& d) { return d.quantile(xi); };
        double lo = least(component_quantile), hi = greatest(component_quantile);
        if (!(lo < hi)) return lo;
        return increasing_root(finite(lo), finite(hi), finite(hi),
                               [&](double x) { return std::pair(cdf(x) - xi, pdf(x)); });
    }
    double quantile_complement(double q) const {
        if (q > 0.5) return quantile(1 - q);
        auto component_quantile = [&](const D& d) { return montelux::quantile_complement(d, q); };
        double lo = least(component_quantile), hi = greatest(component_quantile);
        if (!(lo < hi)) return lo;
        return increasing_root(finite(lo), finite(hi), finite(lo),
                               [&](double x) { return std::pair(q - cdf_complement(x), pdf(x)); });
    }
    // By composition: xi picks a component, and where it fell in that component's share is the uniform number
    // that the component is sampled with. Costs one quantile of one component; follows the same density as
    // quantile(xi), and is increasing in xi within each component's share only.
    double sample(double xi) const {
        DiscreteSample<double> chosen = weights_.sample(xi);
        return sample_by_inversion(components_[chosen.index], chosen.remapped);
    }

  private:
    static double finite(double x) {
        constexpr double limit = std::numeric_limits<double>::max();
        return std::clamp(x, -limit, limit);
    }
    template <typename Value>
    double sum(const Value& value) const {
        double total = 0;
        for (std::size_t i = 0; i < size(); ++i)
            if (weight(i) > 0) total += weight(i) * value(components_[i]);
        return total;
    }
    template <typename Value>
    double least(const Value& value) const {
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < size(); ++i)
            if (weight(i) > 0) best = std::min<double>(best, value(components_[i]));
        return best;
    }
    template <typename Value>
    double greatest(const Value& value) const {
        double best = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < size(); ++i)
            if (weight(i) > 0) best = std::max<double>(best, value(components_[i]));
        return best;
    }

    DiscreteDistribution weights_;
    std::vector<D> components_;
};

} // namespace montelux
