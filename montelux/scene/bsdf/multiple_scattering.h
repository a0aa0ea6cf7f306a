// with_multiple_scattering: a BSDF whose microfacets light one another.
#pragma once

#include "montelux/scene/bsdf/bsdf.h"

namespace montelux {

// The BSDF with conductors and dielectrics replaced by MultiscatterConductorBsdf and MultiscatterDielectricBsdf where
// they are rough, bases and coats of layers included. All others have no microfacets, or stay as they are: measured
// ones contain all scattering, and a rough SubsurfaceBsdf still loses what its facets shadow.
Bsdf with_multiple_scattering(const Bsdf& bsdf);

} // namespace montelux
