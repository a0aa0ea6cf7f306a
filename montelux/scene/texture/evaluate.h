// Values of textures at a point.
#pragma once

#include "montelux/scene/view.h"

namespace montelux {

float evaluate_texture(const SceneView& scene, const FloatTexture& texture, const TextureContext& context);
SampledSpectrum evaluate_texture(const SceneView& scene, const SpectrumTexture& texture,
                                 const TextureContext& context, const SampledWavelengths& lambda);

inline float evaluate(const SceneView& scene, const FloatParameter& parameter,
                      const TextureContext& context) {
    if (parameter.is_constant()) return parameter.value;
    return evaluate_texture(scene, scene.float_textures[parameter.texture], context);
}

inline SampledSpectrum evaluate(const SceneView& scene, const SpectrumParameter& parameter,
                                const TextureContext& context, const SampledWavelengths& lambda) {
    if (parameter.is_constant()) return scene.sample(parameter.value, lambda);
    return evaluate_texture(scene, scene.spectrum_textures[parameter.texture], context, lambda);
}

} // namespace montelux
