// Atmosphere: scattering and absorption by air, aerosol and ozone of a clear sky, and paths through them.
#pragma once

#include <vector>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/vec.h"
#include "montelux/scene/light/sky/bands.h"
#include "montelux/scene/light/sky/sun_disc.h"

namespace montelux {

struct AtmosphereSettings {
    // Vertical optical thickness of air and aerosol over that of air alone, at 550 nm; 1 is pure air.
    double turbidity = 2;
    // Aerosol: optical thickness ~ wavelength^-exponent (Angstrom 1929), share of its extinction that is
    // scattering, and g of Cornette and Shanks' phase function.
    double angstrom_exponent = 1.3;
    double aerosol_albedo = 0.92;
    double aerosol_g = 0.7;
    double ozone = 300; // Dobson units
};

// Lengths in km. The earth is a sphere, seen from heights up to the top of the atmosphere.
inline constexpr double earth_radius = 6371, atmosphere_height = 86;
inline constexpr double atmosphere_radius = earth_radius + atmosphere_height;

// Amounts of the three constituents at a place, or integrated along a path (km): densities relative to those
// at sea level, of ozone relative to its largest.
struct Constituents {
    double air = 0, aerosol = 0, ozone = 0;

    Constituents& operator+=(const Constituents& b) {
        air += b.air, aerosol += b.aerosol, ozone += b.ozone;
        return *this;
    }
    friend Constituents operator+(Constituents a, const Constituents& b) { return a += b; }
    friend Constituents operator*(double s, const Constituents& c) {
        return {s * c.air, s * c.aerosol, s * c.ozone};
    }
};

// Vertical optical thickness of all air above sea level: Bodhaine, Wood, Dutton, Slusser 1999, "On Rayleigh
// Optical Depth Calculations", equation 30.
double rayleigh_optical_thickness(double lambda);
// Per steradian; mu is the cosine of the angle by which light is deflected. Rayleigh scattering by molecules
// that are not round (Bucholtz 1995, "Rayleigh-scattering calculations for the terrestrial atmosphere",
// equation 12, depolarisation 0.0279), without polarisation.
double rayleigh_phase(double mu);
// Cornette and Shanks 1992, "Physically reasonable analytic expression for the single-scattering phase
// function".
double aerosol_phase(double mu, double g);

// Number density of air over that at sea level: US Standard Atmosphere 1976, heights in km up to 86.
double standard_air_density(double height);

class Atmosphere {
  public:
    explicit Atmosphere(const AtmosphereSettings& settings);

    const AtmosphereSettings& settings() const { return settings_; }
    // Aerosol falls off exponentially, by e each 1.2 km. Ozone rises linearly from 10 to 25 km and falls to
    // 40 km (Bruneton 2017).
    Constituents density(double height) const {
        const double at =
            std::clamp(height * (1 / density_step), 0.0, static_cast<double>(density_.size()) - 1.000001);
        const auto i = static_cast<std::size_t>(at);
        const double f = at - static_cast<double>(i);
        return (1 - f) * density_[i] + f * density_[i + 1];
    }
    // The amounts between a height and space in a direction; mu is the cosine to the zenith there. The path
    // must not reach the ground: below horizon_cosine the path at the horizon is returned.
    Constituents path_to_space(double height, double mu) const;
    static double horizon_cosine(double height) {
        const double r = earth_radius / (earth_radius + height);
        return -std::sqrt(std::max(0.0, 1 - r * r));
    }
    // Distance to the top of the atmosphere.
    static double distance_to_space(double height, double mu) {
        const double r = earth_radius + height;
        return -r * mu +
               std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + atmosphere_radius * atmosphere_radius));
    }

    // Per km where the density is 1.
    const Bands& air_scattering() const { return air_; }
    const Bands& aerosol_extinction() const { return aerosol_; }
    const Bands& ozone_absorption() const { return ozone_; }
    Bands extinction(const Constituents& c) const {
        Bands b = static_cast<float>(c.air) * air_;
        b.add(static_cast<float>(c.aerosol), aerosol_);
        b.add(static_cast<float>(c.ozone), ozone_);
        return b;
    }
    // Transmittance of a path.
    Bands transmittance(const Constituents& path) const { return exp(-1.0f * extinction(path)); }
    // For the sun: transmittance to its centre, times the part of its disc above the horizon. mu is the
    // cosine of the centre to the zenith.
    Bands sunlight(double height, double mu) const;
    static double visible_part_of_sun(double height, double mu);

  private:
    static constexpr double density_step = 0.025;
    static constexpr int heights = 192, cosines = 192;

    Constituents integrate_to_space(double height, double mu) const;
    static double height_of_row(int row);
    static double cosine_of_column(double height, int column);

    AtmosphereSettings settings_;
    std::vector<Constituents> density_, paths_;
    Bands air_, aerosol_, ozone_;
};

} // namespace montelux
