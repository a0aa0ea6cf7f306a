// Shells around a point whose masses fall slowly: what lies closer to it than samples reach.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "montelux/mc/integrate/state_archive.h"
#include "montelux/mc/integrate/trained/unit_density.h"
#include "montelux/mc/integrate/witness/largest_values.h"

namespace montelux {

// Values on the way to a face, an edge, a corner or a pole, from outside to inside. Masses of its dyadic shells fall so
// slowly that uniform points have an infinite variance there: |g| ~ r^-a, where 2 a is at least the codimension.
struct SlowShells {
    static constexpr double free = -1;
    static constexpr std::size_t most = 32; // ends of an integral that are kept
    std::vector<double> place;              // coordinates, or `free`
    std::vector<Witness> shells;            // with their volumes, of 2^(-codimension k) each
    std::vector<double> exponents;          // k

    int codimension() const;
    // Whether masses of a component fall slowly, and all of its values are finite.
    bool is_slow(std::size_t component) const;
};

// Do masses fall so slowly between two shells?
bool fall_slowly(double outer_mass, double inner_mass, double exponents_between, int codimension);

// Part of the integral of |g_c| that lies closer than the nearest of `points`, as expected by their density q at the
// shells. Masses follow a power between two shells, and inside the last one.
double unreached(const SlowShells& slow, std::size_t c, std::span<const double> q, double points);

// Part of the integral that lies closer to all slow ends than points reach, and the end that holds most of it; null where
// none holds anything. Several corners add up; what lies closer to an edge contains what lies closer to its corners.
struct Unreached {
    double mass = 0;
    const SlowShells* at = nullptr;
};
// One for each component. `density`: of the points; null: uniform.
std::vector<Unreached> unreached(std::span<const SlowShells> all, std::size_t components,
                                 const UnitDensity* density, double points);

void save(StateWriter& state, const SlowShells& slow);
void load(StateReader& state, SlowShells& slow);

} // namespace montelux
