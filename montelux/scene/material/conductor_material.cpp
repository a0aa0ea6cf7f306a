#include "montelux/scene/material/conductor_material.h"

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

Bsdf ConductorMaterial::bsdf(const ParameterEvaluator& at) const {
    const ConductorBsdf b = at.conductor(metal, roughness, 1);
    if (has_no_effect(distribution) && has_no_effect(specular_reflectance)) return b;
    return TintedConductorBsdf{{b.eta, b.k, {b.normals, distribution}}, at.reflectance(specular_reflectance)};
}

} // namespace montelux
