// The closed set of BSDFs that materials make.
#pragma once

#include <variant>

#include "montelux/scene/bsdf/coating.h"
#include "montelux/scene/bsdf/conductor.h"
#include "montelux/scene/bsdf/dielectric.h"
#include "montelux/scene/bsdf/diffuse.h"
#include "montelux/scene/bsdf/diffuse_transmission.h"
#include "montelux/scene/bsdf/disney.h"
#include "montelux/scene/bsdf/hair.h"
#include "montelux/scene/bsdf/layered.h"
#include "montelux/scene/bsdf/measured_brdf.h"
#include "montelux/scene/bsdf/multiscatter_conductor.h"
#include "montelux/scene/bsdf/multiscatter_dielectric.h"
#include "montelux/scene/bsdf/plastic.h"
#include "montelux/scene/bsdf/principled.h"
#include "montelux/scene/bsdf/subsurface_boundary.h"
#include "montelux/scene/bsdf/thin_dielectric.h"
#include "montelux/scene/bsdf/tinted.h"

namespace montelux {

using UntiltedBsdf =
    std::variant<DiffuseBsdf, DiffuseTransmissionBsdf, ConductorBsdf, DielectricBsdf, ThinDielectricBsdf,
                 CoatedDiffuseBsdf, LayeredBsdf<DiffuseBsdf>, LayeredBsdf<ConductorBsdf>, HairBsdf,
                 MeasuredBsdf, SubsurfaceBsdf, MultiscatterConductorBsdf, MultiscatterDielectricBsdf,
                 LayeredBsdf<DiffuseBsdf, MultiscatterDielectricBsdf>,
                 LayeredBsdf<MultiscatterConductorBsdf, MultiscatterDielectricBsdf>, PrincipledBsdf<false>,
                 PrincipledBsdf<true>, TintedConductorBsdf, TintedDielectricBsdf, TintedThinDielectricBsdf,
                 PlasticBsdf, DisneySolidBsdf, DisneyOpaqueBsdf, DisneySheetBsdf>;

} // namespace montelux
