// Weights of multiple importance sampling: balance, power, cutoff and maximum heuristics.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "montelux/mc/math/number.h"

namespace montelux {

// Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", section 9.2. Strategy i draws
// n_i samples with density p_i; a weight depends on the q_i = n_i p_i alone. Weights sum to 1 wherever
// some q_i > 0. A strategy with q_i = 0 has weight 0; infinite densities (a delta) take all the weight
// and share it by their counts.

// Weight of strategy f against strategy g, which gets g_share(q_g / q_f) per 1 of f. The ratio keeps powers
// of densities from overflowing.
template <Number T, typename Share>
constexpr T weight_of_two(int nf, T f_pdf, int ng, T g_pdf, Share g_share) {
    using S = ScalarOf<T>;
    constexpr S largest = std::numeric_limits<S>::max();
    const T qf = static_cast<S>(nf) * f_pdf, qg = static_cast<S>(ng) * g_pdf;
    const T finite = 1 / (1 + g_share(qg / qf));
    const T infinite = select(qg > largest, T(static_cast<S>(nf) / static_cast<S>(nf + ng)), T(1));
    return select(qf > 0, select(qf > largest, infinite, finite), T(0));
}
// q_f / (q_f + q_g).
template <Number T>
constexpr T balance_heuristic(int nf, T f_pdf, int ng, T g_pdf) {
    return weight_of_two(nf, f_pdf, ng, g_pdf, [](T ratio) { return ratio; });
}
// Power heuristic with exponent 2: q_f^2 / (q_f^2 + q_g^2).
template <Number T>
constexpr T power_heuristic(int nf, T f_pdf, int ng, T g_pdf) {
    return weight_of_two(nf, f_pdf, ng, g_pdf, [](T ratio) { return ratio * ratio; });
}

// The density of one strategy that weighs as much as two, one sample each: weights of three strategies follow from
// those of two. Infinite densities stay infinite.
template <std::floating_point T>
constexpr T balance_joint_pdf(T f_pdf, T g_pdf) {
    return f_pdf + g_pdf;
}
template <std::floating_point T>
T power_joint_pdf(T f_pdf, T g_pdf) {
    return std::hypot(f_pdf, g_pdf);
}

struct MisHeuristic {
    enum class Kind { balance, power, cutoff, maximum };
    Kind kind = Kind::balance;
    // power: the exponent beta > 0; cutoff: the fraction alpha in [0, 1] of the largest q below which a
    // strategy is dropped; unused otherwise.
    double parameter = 0;

    static constexpr MisHeuristic balance() { return {Kind::balance, 1}; }
    static constexpr MisHeuristic power(double beta = 2) { return {Kind::power, beta}; }
    static constexpr MisHeuristic cutoff(double alpha = 0.1) { return {Kind::cutoff, alpha}; }
    static constexpr MisHeuristic maximum() { return {Kind::maximum, 0}; }
};

// Weight of strategy i where strategy k has q_k = n_k p_k(x). Ties of the maximum heuristic, and
// infinite q, share equally.
template <std::floating_point T>
T mis_weight(const MisHeuristic& heuristic, std::span<const T> q, std::size_t i) {
    T largest = 0;
    for (T v : q) largest = v > largest ? v : largest;
    if (!(q[i] > 0)) return 0;

    std::size_t ties = 0;
    for (T v : q) ties += v == largest;
    T share_of_ties = q[i] == largest ? 1 / static_cast<T>(ties) : T(0);
    if (std::isinf(largest) || heuristic.kind == MisHeuristic::Kind::maximum) return share_of_ties;

    // Relative to the largest, no power and no sum can overflow.
    T alpha = heuristic.kind == MisHeuristic::Kind::cutoff ? static_cast<T>(heuristic.parameter) : T(0);
    T beta = heuristic.kind == MisHeuristic::Kind::power ? static_cast<T>(heuristic.parameter) : T(1);
    auto term = [&](T v) {
        T r = v / largest;
        if (!(r > 0) || r < alpha) return T(0);
        return beta == 1 ? r : beta == 2 ? r * r : std::pow(r, beta);
    };
    T sum = 0;
    for (T v : q) sum += term(v);
    return term(q[i]) / sum;
}
template <std::floating_point T>
T mis_weight(const MisHeuristic& heuristic, std::span<T> q, std::size_t i) {
    return mis_weight(heuristic, std::span<const T>(q), i);
}

} // namespace montelux
