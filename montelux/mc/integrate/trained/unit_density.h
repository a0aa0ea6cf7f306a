// A density on the unit cube that training left behind: a map of Vegas or a mixture of Adaptive.
#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "montelux/mc/integrate/adaptive/mixture_density.h"
#include "montelux/mc/integrate/points.h"
#include "montelux/mc/integrate/state_archive.h"
#include "montelux/mc/integrate/vegas/adaptive_map.h"

namespace montelux {

// Points that a density drew, in order.
struct UnitDraws {
    PointBuffer u;                  // those inside the cube
    std::vector<double> density;    // at each
    std::vector<std::size_t> index; // of each among the draws
};

// q(u). A Gaussian of a mixture may draw points outside of the cube. These are draws, too, at which every
// integrand is zero; so q integrates to 1 minus their probability.
class UnitDensity {
  public:
    UnitDensity(AdaptiveMap map) : density_(std::move(map)) {}
    UnitDensity(MixtureDensity mixture) : density_(std::move(mixture)) {}

    int dimensions() const;
    // The map; null for a mixture.
    const AdaptiveMap* map() const { return std::get_if<AdaptiveMap>(&density_); }
    // The mixture; null for a map.
    const MixtureDensity* mixture() const { return std::get_if<MixtureDensity>(&density_); }

    // The uniform density: Adaptive trains none where uniform points suffice.
    bool uniform() const { return mixture() != nullptr && mixture()->channels() == 1; }

    // A draw for each point of v, uniform in dimensions() + 1 variables; the last one chooses among the parts
    // of a mixture.
    void draw(const PointBatch& v, UnitDraws& draws) const;
    // q at each point; 0 outside of the cube.
    void pdf(const PointBatch& u, std::span<double> density) const;

    void save(StateWriter& state) const;
    // Throws Error for a state that is no density of so many dimensions.
    static UnitDensity load(StateReader& state, int dimensions);

  private:
    std::variant<AdaptiveMap, MixtureDensity> density_;
};

// Density at one point of the cube.
template <typename Density>
double pdf_at(const Density& density, std::span<const double> u) {
    PointBuffer at(1, static_cast<int>(u.size()));
    for (std::size_t d = 0; d < u.size(); ++d) at(0, static_cast<int>(d)) = u[d];
    double q = 1;
    density.pdf(at, std::span(&q, 1));
    return q;
}

} // namespace montelux
