// BSDFs of principled materials with constant parameters.
#pragma once

#include <vector>

#include "montelux/scene/material/parameter_evaluator.h"
#include "montelux/scene/material/principled_material.h"
#include "montelux/spectrum/rgb_spectra.h"

namespace montelux::testing {

// Colours of the materials to test.
inline const SceneSpectrum red_paint = SceneSpectrum::at(0), blue_paint = SceneSpectrum::at(1);

inline std::span<const Spectrum> palette() {
    static const std::vector<Spectrum> spectra{RgbAlbedoSpectrum(RgbColorSpace::srgb(), {0.9f, 0.3f, 0.2f}),
                                               RgbAlbedoSpectrum(RgbColorSpace::srgb(), {0.2f, 0.4f, 0.8f})};
    return spectra;
}

inline Bsdf principled(const PrincipledMaterial& m, SampledWavelengths& lambda) {
    SceneView view;
    view.spectra = palette();
    const TextureContext context{};
    return m.bsdf(ParameterEvaluator(view, 0, context, lambda));
}
inline Bsdf principled(const PrincipledMaterial& m) {
    SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);
    return principled(m, lambda);
}

} // namespace montelux::testing
