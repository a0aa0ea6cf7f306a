// SkyModel: the clear sky of the earth: spectral radiance from all directions, and the sun's.
#pragma once

#include <vector>

#include "montelux/scene/light/sky/atmosphere.h"
#include "montelux/spectrum/spectrum.h"

namespace montelux {

// Range of the sun's elevation, degrees above the horizon; below it only twilight is left.
inline constexpr double lowest_sun = -6, highest_sun = 90;
// Range of AtmosphereSettings::turbidity: pure air to dense haze.
inline constexpr double least_turbidity = 1, most_turbidity = 10;

struct SkySettings {
    // Degrees: above the horizon, and from +x towards +y.
    double elevation = 45, azimuth = 0;
    AtmosphereSettings atmosphere;
    // The ground is Lambertian; between 0 and 1.
    Spectrum ground_albedo{0.2f};
};

// Seen from sea level; +z is up. All light scattered by air, aerosol, ozone and the ground, any number of
// times, without polarisation and refraction; docs/environment-light.md describes the computation and its
// accuracy. Below the horizon is the ground, lit by sun and sky.
class SkyModel {
  public:
    // Takes some tenths of a second. Throws Error for settings out of their ranges.
    explicit SkyModel(const SkySettings& settings = {});

    const SkySettings& settings() const { return settings_; }
    Vec3f sun_direction() const { return sun_; }

    // Spectral radiance, W/(m^2 sr nm), without the sun's disc, looking along the unit vector w.
    SampledSpectrum radiance(Vec3f w, const SampledWavelengths& lambda) const;
    float radiance(Vec3f w, float lambda) const;
    // The same for all wavelengths.
    SpectrumTable radiance(Vec3f w) const;
    // Its mean over the visible wavelengths, and its integrals over them against the CIE's matching
    // functions: times luminous_efficacy, Y is luminance in cd/m^2.
    double mean_radiance(Vec3f w) const;
    Vec3d tristimulus(Vec3f w) const;
    // Radiance of the sun's disc, through the air towards its centre (or to the horizon, if the centre is
    // below it). Uniform over the disc, whose lower part may be below the horizon.
    const SpectrumTable& sun_radiance() const { return sun_radiance_; }
    // Irradiance on the horizontal ground, W/(m^2 nm).
    SpectrumTable sky_irradiance() const { return in_sunlight(sky_irradiance_); }
    SpectrumTable sun_irradiance() const { return in_sunlight(sun_irradiance_); }

    // Memory of the tables.
    std::size_t bytes() const { return (smooth_.capacity() + aureole_.capacity()) * sizeof(Bands); }

  private:
    static constexpr int rows = 65, columns = 33;

    // Between four entries: the one at `first`, and from it by `corners`.
    struct Place {
        std::size_t first;
        std::array<float, 4> share;
        float aerosol_phase;
    };
    static constexpr std::array<std::size_t, 4> corners{0, 1, columns, columns + 1};
    Place place(Vec3f w) const;
    Bands scattering(Vec3f w) const;
    static SpectrumTable in_sunlight(const Bands& share);

    SkySettings settings_;
    Vec3f sun_;
    Vec2f sun_side_;                      // horizontal and of unit length
    std::vector<Bands> smooth_, aureole_; // [row][column]
    Bands ground_, sky_irradiance_, sun_irradiance_;
    SpectrumTable solar_, sun_radiance_;
    Bands mean_weights_;
    std::array<Bands, 3> cie_weights_;
};

} // namespace montelux
