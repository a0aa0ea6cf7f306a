#include "montelux/scene/material/thin_dielectric_material.h"

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

Bsdf ThinDielectricMaterial::bsdf(const ParameterEvaluator& at) const {
    const ThinDielectricBsdf b{at.refractive_index(eta)};
    if (has_no_effect(specular_reflectance) && has_no_effect(specular_transmittance)) return b;
    return TintedThinDielectricBsdf{b, at.reflectance(specular_reflectance),
                                    at.reflectance(specular_transmittance)};
}

} // namespace montelux
