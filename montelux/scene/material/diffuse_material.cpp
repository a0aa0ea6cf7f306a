#include "montelux/scene/material/diffuse_material.h"

#include "montelux/scene/bsdf/diffuse.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

DiffuseBsdf DiffuseMaterial::bsdf(const ParameterEvaluator& at) const {
    return {at.reflectance(reflectance)};
}

} // namespace montelux
