#include "montelux/scene/material/principled_material.h"

#include <algorithm>
#include <cmath>

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

Bsdf PrincipledMaterial::bsdf(const ParameterEvaluator& at) const {
    const PrincipledLayers layers = evaluated(at);
    if (layers.interface.is_clear() || !is_black(layers.transmitting)) return PrincipledBsdf<true>{layers};
    return PrincipledBsdf<false>{layers};
}

PrincipledLayers PrincipledMaterial::evaluated(const ParameterEvaluator& at) const {
    const SampledSpectrum color = at.reflectance(base_color);
    const float metal = at.share(metallic), clear = at.share(transmission);
    const float sheet = at.share(diffuse_transmission);
    const float opaque = (1 - metal) * (1 - clear);

    PrincipledLayers l;
    l.interface = evaluated_interface(at, color, metal, clear);
    l.diffuse = (opaque * (1 - sheet)) * color;
    l.transmitting = SampledSpectrum(0);
    if (opaque * sheet > 0) l.transmitting = (opaque * sheet) * at.reflectance(diffuse_transmission_color);
    l.sheen_color = at.reflectance(sheen_color);
    l.sheen = Sheen::from_roughness(at.share(sheen_roughness));
    l.coat = at.share(clearcoat);
    const float r = at.share(clearcoat_roughness);
    l.coat_ggx = at.microfacets(r * r, r * r);
    return l;
}

PrincipledInterface PrincipledMaterial::evaluated_interface(const ParameterEvaluator& at,
                                                            SampledSpectrum color, float metal,
                                                            float clear) const {
    PrincipledInterface i;
    // KHR_materials_anisotropy: the roughness grows along x only.
    const float r = at.share(roughness), alpha = r * r, stretch = at.share(anisotropy);
    i.ggx = at.microfacets(alpha + (1 - alpha) * stretch * stretch, alpha);
    if (const float angle = at(anisotropy_rotation); angle != 0) {
        i.turn_cos = std::cos(angle);
        i.turn_sin = std::sin(angle);
    }

    i.dielectric = 1 - metal;
    i.metal = metal;
    i.clear = clear;
    i.thin = thin_walled;
    i.tint = color;
    float n = at(ior);
    if (i.is_clear() && !thin_walled) n = dispersed(at, n);
    // Almost equal indices would need the difference of almost equal vectors.
    i.eta = n > 0 && std::abs(n - 1) > 1e-3f ? n : 1;

    const float f0 = n > 0 ? (n - 1) / (n + 1) : 1;
    i.specular = at.share(specular);
    i.dielectric_f0 = min(f0 * f0 * clamp_zero(at(specular_color)), SampledSpectrum(1));
    i.metal_f0 = color;
    if (const float thickness = at(iridescence_thickness); thickness > 0) {
        i.film_share = at.share(iridescence);
        i.film = ThinFilm::make(std::max(at(iridescence_ior), 1.0f), thickness, at.wavelengths());
    }
    i.set_bounds();
    return i;
}

float PrincipledMaterial::dispersed(const ParameterEvaluator& at, float n) const {
    const float strength = at(dispersion);
    if (!(strength > 0) || !(n > 1)) return n;
    const float lambda = at.hero_wavelength();
    return std::max(1.0f, n + (n - 1) * strength / 20 * (523655 / (lambda * lambda) - 1.5168f));
}

} // namespace montelux
