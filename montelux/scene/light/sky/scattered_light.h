// ScatteredLight: multiply scattered light, by discrete ordinates in columns of air under different suns.
#pragma once

#include <array>
#include <vector>

#include "montelux/scene/light/sky/atmosphere.h"
#include "montelux/scene/light/sky/sky_harmonics.h"

namespace montelux {

// In each column the air is assumed flat, and so the same at all distances (discrete ordinates, Chandrasekhar
// 1960, "Radiative Transfer", solved by successive orders of scattering); sunlight reaches it around the
// curved earth (pseudo-spherical approximation, Dahlback and Stamnes 1991). The light at each height is
// stored in spherical harmonics; the last scattering towards the eye is integrated along the curved path:
// Rozanov et al. 2001, "Limb scattering measurements: combined differential-integral approach". So curvature
// is neglected only between the first and the last scattering.
class ScatteredLight {
    static constexpr int levels = 44, most_side_columns = 8, most_columns = 2 * most_side_columns + 1;

  public:
    // Columns whose sun is within `range` radians of the angle `sun_zenith`. Lambertian ground.
    ScatteredLight(const Atmosphere& atmosphere, const Bands& ground_albedo, double sun_zenith, double range);

    // Light scattered per km towards an eye, for sunlight of irradiance 1 outside, without direct sunlight.
    // For one position and all azimuths: at a height, looking with cosine mu to the zenith there.
    class Source {
      public:
        Source(const ScatteredLight& light, double height, double mu, const Constituents& density);
        // The sun at a zenith angle and at an azimuth of this cosine from that of the eye's direction.
        Bands operator()(double sun_zenith, double cos_azimuth);

      private:
        const std::array<Bands, sky_order + 1>& column(int column);

        const ScatteredLight* light_;
        int level_;
        float rise_; // above that level, of the distance to the next
        std::array<double, sky_terms> harmonics_;
        std::array<Bands, sky_order + 1> scattering_; // of each order per km
        // Coefficients of cos(m azimuth) in the columns that were asked for.
        std::vector<std::array<Bands, sky_order + 1>> coefficients_;
        std::array<int, most_columns> place_;
    };

    // Share of aerosol phase in each order: 2 pi times the integral of phase P_l.
    static std::vector<double> phase_moments(double (*phase)(double mu, double g), double g, int order);

  private:
    static constexpr int streams = 8;      // of each hemisphere
    static constexpr int first_order = 48; // of the phase function for light from the sun

    struct Layers;
    static double level_height(int level);
    double column_angle(int column) const;
    void solve(const Layers& layers, const Atmosphere& atmosphere, const Bands& ground_albedo, int column);
    Bands* light(int column, int level) {
        return &light_[(static_cast<std::size_t>(column) * levels + static_cast<std::size_t>(level)) *
                       sky_terms];
    }
    const Bands* light(int column, int level) const {
        return const_cast<ScatteredLight*>(this)->light(column, level);
    }

    double sun_zenith_, range_;
    int side_columns_;    // on either side of the one at the eye
    Bands air_, aerosol_; // scattering per km at density 1
    std::vector<double> air_moments_, aerosol_moments_;
    std::vector<Bands> light_;
};

} // namespace montelux
