// Reflection by a semi-infinite medium, and the medium that has a given reflectance.
#pragma once

namespace montelux {

// Share of diffuse light falling on a half-space of isotropically scattering particles that leaves it again, with no
// change of index at the boundary: 1 - 2 sqrt(1 - a) h with the first moment h of Chandrasekhar's H function
// (Chandrasekhar 1960, "Radiative Transfer", section V). The single-scattering albedo a lies in [0, 1].
double semi_infinite_diffuse_albedo(double single_scattering_albedo);

// The single-scattering albedo of the medium below the boundary of SubsurfaceBsdf, so that the given share of the light
// that has entered leaves again. Both lie in [0, 1]; eta >= 1. Accurate to 1e-4.
float single_scattering_albedo(float reflectance, float eta);
// The same for a phase function of mean cosine g: the medium has the reduced scattering coefficient of the isotropic
// one (van de Hulst's similarity) and the same extinction.
float body_albedo(float reflectance, float eta, float g);

} // namespace montelux
