#include "montelux/scene/material/dielectric_material.h"

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

Bsdf DielectricMaterial::bsdf(const ParameterEvaluator& at) const {
    const DielectricBsdf b{at.refractive_index(eta), at.roughness(roughness)};
    if (has_no_effect(distribution) && has_no_effect(specular_reflectance) &&
        has_no_effect(specular_transmittance))
        return b;
    return TintedDielectricBsdf{{b.eta, {b.normals, distribution}},
                                at.reflectance(specular_reflectance),
                                at.reflectance(specular_transmittance)};
}

} // namespace montelux
