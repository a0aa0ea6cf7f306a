#include "montelux/scene/build/emission.h"

#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux {

float photometric_scale(const Spectrum& spectrum) {
    const double y = to_photometric(spectrum);
    // A black light stays black.
    if (y == 0) return 0;
    if (!(y > 0) || !std::isfinite(y)) throw Error("the light's spectrum has no positive luminance");
    return static_cast<float>(1 / y);
}

float point_intensity(float flux) { return flux / (4 * pi_f); }

float spot_intensity(float flux, double cos_falloff_start, double cos_total_width) {
    const double start = cos_falloff_start, end = cos_total_width;
    return static_cast<float>(static_cast<double>(flux) / (2 * pi * ((1 - start) + (start - end) / 2)));
}

float sky_luminance(float illuminance) { return illuminance / pi_f; }

AreaLight Emission::light(Index shape, const Geometry& geometry) const {
    AreaLight light{.spectrum = spectrum,
                    .scale = scale,
                    .two_sided = two_sided,
                    .shape = shape,
                    .picture = picture,
                    .picture_lookup = picture_lookup,
                    .equal_energy = equal_energy};
    if (!(power > 0)) return light;
    const float power_of_white = static_cast<float>(static_cast<double>(power) / picture_mean);
    const auto* quadric = std::get_if<Quadric>(&geometry);
    if (quadric == nullptr)
        light.primitive_flux = power_of_white;
    else if (const float area = object_area(*quadric); area > 0)
        light.scale *= power_of_white / ((two_sided ? 2.0f : 1.0f) * area * pi_f);
    return light;
}

} // namespace montelux
