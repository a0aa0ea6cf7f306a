#include "montelux/scene/material/subsurface_material.h"

#include "montelux/scene/bsdf/subsurface_boundary.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

SubsurfaceBsdf SubsurfaceMaterial::bsdf(const ParameterEvaluator& at) const {
    return SubsurfaceBsdf::make(eta, at.roughness(roughness));
}

} // namespace montelux
