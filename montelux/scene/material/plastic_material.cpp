#include "montelux/scene/material/plastic_material.h"

#include "montelux/scene/bsdf/plastic.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

PlasticBsdf PlasticMaterial::bsdf(const ParameterEvaluator& at) const {
    const PlasticTable& table = at.plastic_table();
    return {&table,
            {at.microfacets(alpha, alpha), distribution},
            table.base_albedo(at.reflectance(reflectance), nonlinear, internal_reflectance),
            at.reflectance(specular_reflectance)};
}

} // namespace montelux
