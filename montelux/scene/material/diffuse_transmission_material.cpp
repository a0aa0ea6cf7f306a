#include "montelux/scene/material/diffuse_transmission_material.h"

#include "montelux/scene/bsdf/diffuse_transmission.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

DiffuseTransmissionBsdf DiffuseTransmissionMaterial::bsdf(const ParameterEvaluator& at) const {
    const SampledSpectrum r = at(reflectance), t = at(transmittance);
    return {clamp(r * scale, 0, 1), clamp(t * scale, 0, 1)};
}

} // namespace montelux
