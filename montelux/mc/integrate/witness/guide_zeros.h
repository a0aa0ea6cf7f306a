// Places where the guides of an integrand are zero, near which it may have features.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/integrand.h"

namespace montelux {

struct GuideZero {
    std::vector<double> u; // of the unit cube; 0.5 in variables that the guide does not depend on
    std::size_t guide;
};

// Places inside of the cube where a guide is zero, up to eight of each, each place once: climbs log(1/|guide|) from
// scattered points, where the guide has a slope even if the integrand has underflowed. A climb that ends at a face goes
// on at the opposite one where that is the same place. Domains of up to eight variables; of others none. `seed`: of the
// scattered points.
std::vector<GuideZero> guide_zeros(std::span<const Integrand::BatchFunction> guides, const Domain& domain,
                                   std::uint64_t seed);

// A guide's value at a point of the cube.
double guide_at(const Integrand::BatchFunction& guide, const Domain& domain, std::span<const double> u);

// The place of a guide's zero to which a climb from u leads, along all variables or all but the fixed one.
std::vector<double> climb_to_zero(const Integrand::BatchFunction& guide, const Domain& domain,
                                  std::vector<double> u, std::optional<std::size_t> fixed = {});

} // namespace montelux
