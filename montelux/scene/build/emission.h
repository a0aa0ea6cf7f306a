// Emission: the emission of lights in photometric units: spectra scaled so that the film's RGB is luminance.
#pragma once

#include <string>

#include "montelux/scene/build/geometry.h"
#include "montelux/scene/light/area_light.h"
#include "montelux/scene/light/picture_lookup.h"

namespace montelux {

// 1 over the luminance of a light's spectrum: the factor of its scale by which an RGB colour of (1, 1, 1), or
// any other spectrum, has a luminance, illuminance or intensity of 1 (to_photometric). 0 for black. Throws
// Error for a spectrum without positive luminance.
float photometric_scale(const Spectrum& spectrum);

// Intensity (cd) of a point light per flux (lm).
float point_intensity(float flux);
// The same on the axis of a spot light, whose falloff is a smoothstep between two cosines.
float spot_intensity(float flux, double cos_falloff_start, double cos_total_width);
// Luminance (cd/m^2) of a uniform sky per illuminance (lx) of a patch that faces it.
float sky_luminance(float illuminance);

// The emission assigned to a shape; with `power` it depends on the shape.
struct Emission {
    SceneSpectrum spectrum;
    float scale = 1; // radiance is scale * spectrum
    bool two_sided = false;
    float power = 0; // lm of each primitive, if positive: scale is then multiplied by power / emitted power
    Index picture = no_index; // AreaLight::picture
    PictureLookup picture_lookup = PictureLookup::bilinear;
    bool equal_energy = false;
    double picture_mean = 1; // luminance, by which the emitted power is multiplied
    std::string group{};     // of lights that share a layer (light_groups.h); may be empty

    // The light of a shape with this geometry.
    AreaLight light(Index shape, const Geometry& geometry) const;
};

} // namespace montelux
