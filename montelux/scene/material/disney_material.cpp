#include "montelux/scene/material/disney_material.h"

#include <algorithm>

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

Bsdf DisneyMaterial::bsdf(const ParameterEvaluator& at) const {
    const SampledSpectrum color = at.reflectance(base_color);
    const float metal = at.share(metallic), clear = at.share(specular_transmission);
    const float opaque = (1 - metal) * (1 - clear);

    DisneySolid l;
    l.base.roughness = at.share(roughness);
    l.base.flatness = at.share(flatness);
    l.base.color = opaque * color;
    l.base.sheen_color = SampledSpectrum(0);
    const float fibres = opaque > 0 ? (1 - metal) * std::max(at(sheen), 0.0f) : 0;
    if (fibres > 0) l.base.sheen_color = fibres * at.tint(base_color, at.share(sheen_tint));
    l.normals = at.disney_microfacets(l.base.roughness, at.share(anisotropic));
    l.eta = disney_index(eta);
    l.metallic = metal;
    l.transmitting = (1 - metal) * clear;
    l.color = color;
    l.tinted = at.share(specular_tint);
    l.tinted_f0 = SampledSpectrum(0);
    if (l.tinted > 0) l.tinted_f0 = disney_f0(l.eta) * at.tint(base_color, 1);
    l.coat = at.share(clearcoat);
    l.coat_alpha = 0.1f + (0.001f - 0.1f) * at.share(clearcoat_gloss);
    if (l.transmits()) return DisneySolidBsdf{l};
    return DisneyOpaqueBsdf{l};
}

DisneySheetBsdf DisneyThinMaterial::bsdf(const ParameterEvaluator& at) const {
    const SampledSpectrum color = at.reflectance(base_color);
    const float clear = at.share(specular_transmission), crossing = at.share(diffuse_transmission);
    const float stretch = at.share(anisotropic);

    DisneySheet l;
    l.eta = disney_index(at(eta));
    l.base.roughness = at.share(roughness);
    l.base.flatness = at.share(flatness);
    l.base.color = ((1 - clear) * (1 - crossing)) * color;
    l.base.sheen_color = SampledSpectrum(0);
    const float fibres = (1 - clear) * (1 - crossing) * std::max(at(sheen), 0.0f);
    if (fibres > 0) l.base.sheen_color = fibres * at.tint(base_color, at.share(sheen_tint));
    l.reflecting = at.disney_microfacets(l.base.roughness, stretch);
    // Burley 2015, figure 15.
    l.crossing = at.disney_microfacets((0.65f * l.eta - 0.35f) * l.base.roughness, stretch);
    l.clear = clear;
    l.color = color;
    l.tinted = at.share(specular_tint);
    l.tinted_f0 = SampledSpectrum(0);
    if (l.tinted > 0) l.tinted_f0 = disney_f0(l.eta) * at.tint(base_color, 1);
    l.transmitting = ((1 - clear) * crossing) * color;
    return {l};
}

} // namespace montelux
