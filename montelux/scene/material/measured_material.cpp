#include "montelux/scene/material/measured_material.h"

#include "montelux/scene/bsdf/measured_brdf.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

MeasuredBsdf MeasuredMaterial::bsdf(const ParameterEvaluator& at) const { return at.measured(brdf); }

} // namespace montelux
