#include "montelux/scene/material/hair_material.h"

#include "montelux/scene/bsdf/hair.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

HairBsdf HairMaterial::bsdf(const ParameterEvaluator& at) const {
    const float n = at(beta_n);
    return HairBsdf::make(at.offset_across(), at(eta), at.hair_absorption(color, n), at(beta_m), n,
                          at(alpha));
}

} // namespace montelux
