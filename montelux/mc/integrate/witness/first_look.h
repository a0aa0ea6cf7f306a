// The first look of a run: the integrand at points by scales, around the places where peaks and poles usually lie.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/evaluator.h"
#include "montelux/mc/integrate/witness/peak.h"
#include "montelux/mc/integrate/witness/slow_shells.h"

namespace montelux {

struct FirstLook {
    // Points with finite values; the volume is that of the shell in which a point lies.
    std::vector<Witness> witnesses;
    // Tops that stand far above the others. Along each variable |g| stays above a half of its value there within
    // `volume`, a box; where variables are correlated the box is smaller than the peak.
    std::vector<Witness> peaks;
    // The greatest value on diagonals that lie on ridges, or on surfaces of poles; none if there are none.
    std::vector<Witness> on_ridges;
    // Part of the integral of |g_c| that lies closer to an end or a pole of one variable, or farther out, than doubles
    // resolve; one for each component, or none.
    std::vector<double> unresolved;
    // Where values are noise: the part of the integral that lies there is unresolved.
    std::vector<NoiseBox> noise;
    // Ways to ends along which |g| grows fast, though its mass falls.
    std::vector<SlowShells> slow;
    // Where the mass of |g| in dyadic shells does not fall, as "x -> 0"; empty where it falls everywhere.
    std::string divergence;
    bool found_by_chance = false; // whether random points have found other peaks since
    std::uint64_t evaluations = 0;
    double seconds = 0; // wall time of the evaluations
};

struct LookSettings {
    // Points near which a feature may lie, such as the numbers of a formula.
    std::span<const std::vector<double>> landmarks = {};
    // Functions that are zero where a feature may lie, such as the brackets of a formula.
    std::span<const Integrand::BatchFunction> guides = {};
    std::uint64_t most_evaluations = 2048;
    std::uint64_t seed = 0;
};

// Points at distances of 2^-3 to 2^-50 of the cube's width from its corners and its centre, from the origin and from
// the landmarks and zeros of the guides: all variables at a time, then each by itself through the greatest value. What
// stands out is climbed along each variable and its widths are measured. 24 evaluations in one variable if there are no
// landmarks and nothing stands out; about 100 + 30 n in n. A value that is not finite is no error here: an infinite one
// counts as a shell that grows, NaN as nothing.
FirstLook first_look(const Evaluator& evaluator, const LookSettings& settings = {});

// A point of the cube as "(0.3, 0.7)", in the domain's coordinates.
std::string place_text(const Domain& domain, std::span<const double> u);
// The limit towards it as "(x1, x2) -> (0.3, 0.7)".
std::string limit_text(const Domain& domain, std::span<const double> u);

} // namespace montelux
