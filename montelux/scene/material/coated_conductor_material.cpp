#include "montelux/scene/material/coated_conductor_material.h"

#include <cmath>

#include "montelux/scene/bsdf/conductor.h"
#include "montelux/scene/bsdf/layered.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

LayeredBsdf<ConductorBsdf> CoatedConductorMaterial::bsdf(const ParameterEvaluator& at) const {
    const float eta = at.refractive_index(coating.eta);
    const ConductorBsdf base = at.conductor(metal, roughness, eta);
    const Ggx coat = at.roughness(coating.roughness);
    // Light crosses the coat twice: the widths of the lobes add.
    auto widen = [](float a, float b) { return std::max(std::sqrt(a * a + 2 * b * b), 2e-3f); };
    const Ggx proxy{widen(base.normals.alpha_x, coat.alpha_x), widen(base.normals.alpha_y, coat.alpha_y)};
    return at.layered(coating, eta, base, proxy);
}

} // namespace montelux
