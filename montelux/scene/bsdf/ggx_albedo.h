// The share of light that GGX microfacets reflect because of Schlick's rise at grazing incidence.
#pragma once

#include "montelux/scene/bsdf/ggx.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// An upper bound of the directional albedo of (1 - cos(wo, m))^5 with single scattering, above it by 0.003 in the
// mean and by 0.05 at most, at grazing angles.
float ggx_grazing_albedo(Ggx ggx, float cos_theta);

// An upper bound of the directional albedo of microfacets with fresnel_schlick(f0, f90): light that masking
// takes away counts as reflected.
inline SampledSpectrum ggx_schlick_albedo(Ggx ggx, float cos_theta, SampledSpectrum f0, float f90) {
    const float b = ggx_grazing_albedo(ggx, cos_theta);
    return f0 + b * (f90 - f0); // where both are 1, exactly 1
}

} // namespace montelux
