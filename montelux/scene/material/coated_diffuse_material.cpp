#include "montelux/scene/material/coated_diffuse_material.h"

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

Bsdf CoatedDiffuseMaterial::bsdf(const ParameterEvaluator& at) const {
    const SampledSpectrum rho = at.reflectance(reflectance);
    if (const CoatingTable* table = at.coating_table())
        return CoatedDiffuseBsdf{table, table->base_albedo(rho)};
    const float eta = at.refractive_index(coating.eta);
    return at.layered(coating, eta, DiffuseBsdf{rho}, Ggx{0.7f, 0.7f});
}

} // namespace montelux
