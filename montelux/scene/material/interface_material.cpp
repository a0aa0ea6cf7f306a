#include "montelux/scene/material/interface_material.h"

#include "montelux/scene/bsdf/thin_dielectric.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

ThinDielectricBsdf InterfaceMaterial::bsdf(const ParameterEvaluator&) const { return {1}; }

} // namespace montelux
