#include "montelux/scene/light/sky/line_of_sight.h"

#include <algorithm>
#include <cmath>

namespace montelux {

namespace {

constexpr int steps = 64;

} // namespace

std::vector<LineOfSight> look(const Atmosphere& atmosphere, const ScatteredLight& scattered,
                              double sun_zenith, double mu, std::span<const double> cos_azimuths) {
    const double sin_view = std::sqrt(std::max(0.0, 1 - mu * mu));
    const double cos_sun = std::cos(sun_zenith), sin_sun = std::sin(sun_zenith);
    const double length = Atmosphere::distance_to_space(0, mu);
    const Bands aerosol_scattering =
        static_cast<float>(atmosphere.settings().aerosol_albedo) * atmosphere.aerosol_extinction();

    std::vector<LineOfSight> seen(cos_azimuths.size());
    Bands transmittance(1);
    double begin = 0;
    for (int i = 0; i < steps; ++i) {
        // Steps grow along the line: distances are length t^3.
        const double t = (i + 1.0) / steps;
        const double end = length * t * t * t, middle = 0.5 * (begin + end);
        const auto step = static_cast<float>(end - begin);
        begin = end;

        // The position, in the plane of the zenith and the line.
        const double along = middle * sin_view, up = earth_radius + middle * mu;
        const double r = std::hypot(along, up), height = r - earth_radius;
        const double mu_view = std::clamp((along * sin_view + up * mu) / r, -1.0, 1.0);
        const Constituents density = atmosphere.density(height);
        const Bands extinction = atmosphere.extinction(density);
        const Bands air = static_cast<float>(density.air) * atmosphere.air_scattering();
        const Bands aerosol = static_cast<float>(density.aerosol) * aerosol_scattering;
        Bands passing; // transmittance to the step, its mean within, and its length
        for (std::size_t v = 0; v < Bands::vectors; ++v) {
            const Float4 thickness = extinction.v[v] * step, through = exp(-thickness);
            const Float4 within =
                select(thickness < broadcast(0.01f), 1.0f - thickness * (0.5f - thickness / 6),
                       (1.0f - through) / max(thickness, broadcast(1e-30f)));
            passing.v[v] = transmittance.v[v] * within * step;
            transmittance.v[v] *= through;
        }
        ScatteredLight::Source source(scattered, height, mu_view, density);
        for (std::size_t a = 0; a < cos_azimuths.size(); ++a) {
            const double cos_between = sin_view * cos_azimuths[a] * sin_sun + mu * cos_sun;
            const double mu_sun =
                std::clamp((along * cos_azimuths[a] * sin_sun + up * cos_sun) / r, -1.0, 1.0);
            const double sines = std::sqrt(std::max(0.0, (1 - mu_sun * mu_sun) * (1 - mu_view * mu_view)));
            const double azimuth =
                sines > 1e-12 ? std::clamp((cos_between - mu_sun * mu_view) / sines, -1.0, 1.0) : 1.0;
            const Bands from_sun = passing * atmosphere.sunlight(height, mu_sun);
            seen[a].smooth += passing * source(std::acos(mu_sun), azimuth);
            seen[a].smooth += static_cast<float>(rayleigh_phase(cos_between)) * air * from_sun;
            seen[a].aureole += aerosol * from_sun;
        }
    }
    // Truncated harmonics may be slightly negative in darkness.
    for (LineOfSight& line : seen)
        for (Float4& v : line.smooth.v) v = max(v, Float4{});
    return seen;
}

} // namespace montelux
