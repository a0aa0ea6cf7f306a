// Values of textures at a point.
#pragma once

#include "montelux/scene/scene.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {

float evaluate_texture(const Scene& scene, const SceneTables& tables, const FloatTexture& texture,
                       const TextureContext& context);
SampledSpectrum evaluate_texture(const Scene& scene, const SceneTables& tables,
                                 const SpectrumTexture& texture, const TextureContext& context,
                                 const SampledWavelengths& lambda);

inline float evaluate(const Scene& scene, const SceneTables& tables, const FloatParameter& parameter,
                      const TextureContext& context) {
    if (parameter.is_constant()) return parameter.value;
    return evaluate_texture(scene, tables, scene.float_textures[parameter.texture], context);
}

inline SampledSpectrum evaluate(const Scene& scene, const SceneTables& tables,
                                const SpectrumParameter& parameter, const TextureContext& context,
                                const SampledWavelengths& lambda) {
    if (parameter.is_constant()) return parameter.value.sample(lambda);
    return evaluate_texture(scene, tables, scene.spectrum_textures[parameter.texture], context, lambda);
}

} // namespace montelux
