// Multiple importance sampling: several techniques for one integral, combined by weights.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>

#include "montelux/mc/integrate/mis.h"
#include "montelux/mc/integrate/sample_loop.h"
#include "montelux/mc/integrate/technique.h"

namespace montelux {

// A technique and the number of samples that it draws.
template <typename Technique>
struct WeightedTechnique {
    Technique technique; // SamplingTechnique, Distribution1D or ProductDistribution
    std::uint64_t samples;
};
template <typename Technique>
WeightedTechnique(Technique, std::uint64_t) -> WeightedTechnique<Technique>;

// F = sum over techniques i of 1/n_i * sum over j of w_i(X_ij) f(X_ij) / p_i(X_ij), X_ij ~ p_i (Veach 1997,
// eq. 9.4). The densities must be in one measure; wherever f != 0 at least one must be above zero, and the
// estimate is then unbiased for every heuristic. Each technique's inner sum is divided by its own n_i. The
// standard error adds the variances of the techniques, which are independent.
template <typename F, typename... Techniques>
Estimate multiple_importance_sampling(const F& f, const MisHeuristic& heuristic, std::uint64_t seed,
                                      const WeightedTechnique<Techniques>&... weighted) {
    constexpr std::size_t count = sizeof...(Techniques);
    static_assert(count > 0);
    auto techniques = std::make_tuple(as_technique(weighted.technique)...);
    const std::array<std::uint64_t, count> n{weighted.samples...};

    Estimate total;
    double variance = 0;
    auto add_technique = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
        if (n[I] == 0) return;
        const auto& technique = std::get<I>(techniques);
        constexpr std::size_t dimensions = std::remove_cvref_t<decltype(technique)>::dimensions;
        SampleSum sum = sum_samples(n[I], [&](std::uint64_t j) {
            auto x = technique.sample(sample_uniforms<dimensions>(seed, static_cast<std::uint32_t>(I), j));
            double y = f(x);
            if (y == 0) return 0.0;
            std::array<double, count> p = std::apply(
                [&](const auto&... t) { return std::array<double, count>{static_cast<double>(t.pdf(x))...}; },
                techniques);
            std::array<double, count> q;
            for (std::size_t k = 0; k < count; ++k) q[k] = static_cast<double>(n[k]) * p[k];
            // A drawn point of density zero contradicts its own technique: the quotient shows it.
            if (!(p[I] > 0)) return y / p[I];
            return mis_weight(heuristic, std::span<const double>(q), I) * y / p[I];
        });
        total.value += sum.moments.mean();
        variance += sum.moments.variance_of_mean();
        total.evaluations += n[I];
        total.non_finite += sum.non_finite;
        if (total.first_non_finite == Estimate::no_index) total.first_non_finite = sum.first_non_finite;
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (add_technique(std::integral_constant<std::size_t, I>{}), ...);
    }
    (std::make_index_sequence<count>{});
    if (total.evaluations == 0) throw Error("multiple_importance_sampling", "no technique draws a sample");
    total.standard_error = std::sqrt(variance);
    return total;
}

} // namespace montelux
