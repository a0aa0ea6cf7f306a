#include "montelux/scene/material/sided_material.h"

#include "montelux/scene/bsdf/diffuse.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

DiffuseBsdf SidedMaterial::bsdf(const ParameterEvaluator&) const { return {SampledSpectrum(0)}; }

} // namespace montelux
