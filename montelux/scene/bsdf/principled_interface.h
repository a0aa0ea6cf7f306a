// PrincipledInterface: the microfacets of a principled material, which reflect as a metal and as a dielectric, and
// through which light may pass.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/scene/bsdf/fresnel.h"
#include "montelux/scene/bsdf/ggx.h"
#include "montelux/scene/bsdf/ggx_albedo.h"
#include "montelux/scene/bsdf/thin_film.h"

namespace montelux {

// Reflectances of a microfacet by the angle to its normal: glTF 2.0, appendix B, with KHR_materials_specular,
// KHR_materials_ior, KHR_materials_transmission and KHR_materials_iridescence. `dielectric` and `metal` add up to
// 1; the share `clear` of the dielectric lets light pass, the rest covers a diffuse base.
struct PrincipledInterface {
    Ggx ggx;
    float turn_cos = 1, turn_sin = 0; // of the angle from the tangent to the x axis of ggx

    float dielectric = 1, metal = 0;
    float specular = 1; // weight of the dielectric's reflection
    float film_share = 0;
    float clear = 0;
    float eta = 1.5f;  // index below the surface over that above; 1: light is not bent
    bool thin = false; // a sheet: light leaves it mirrored at its plane
    SampledSpectrum dielectric_f0, metal_f0;
    SampledSpectrum dielectric_bound,
        metal_bound; // as f0 of Schlick's reflectance, with the film; by set_bounds
    ThinFilm film;
    SampledSpectrum tint; // factor of light that passes

    // To be called when all else is set.
    void set_bounds() {
        dielectric_bound = bound(dielectric_f0);
        metal_bound = bound(metal_f0);
    }

    bool is_clear() const { return clear * dielectric > 0; }
    // Light goes straight on through all microfacets.
    bool is_straight() const { return eta == 1 && !thin; }

    SampledSpectrum dielectric_reflectance(float cos_theta) const {
        return specular * with_film(cos_theta, dielectric_f0);
    }
    // cos_theta: angle between the direction and the microfacet's normal on its side, in [0, 1].
    SampledSpectrum reflectance(float cos_theta, bool above) const {
        SampledSpectrum r(0);
        if (metal > 0) r = metal * with_film(cos_theta, metal_f0);
        if (!(dielectric > 0)) return r;
        if (clear < 1) r += (dielectric * (1 - clear)) * dielectric_reflectance(cos_theta);
        if (clear > 0) r += (dielectric * clear) * clear_reflectance(cos_theta, above);
        return r;
    }
    SampledSpectrum transmittance(float cos_theta, bool above) const {
        return (dielectric * clear) * tint * (1.0f - clear_reflectance(cos_theta, above));
    }

    // Upper bounds of the directional albedos of both reflections.
    SampledSpectrum dielectric_albedo(float cos_theta) const {
        return specular * ggx_schlick_albedo(ggx, cos_theta, dielectric_bound, 1);
    }
    SampledSpectrum metal_albedo(float cos_theta) const {
        return ggx_schlick_albedo(ggx, cos_theta, metal_bound, 1);
    }

  private:
    SampledSpectrum with_film(float cos_theta, SampledSpectrum f0) const {
        const SampledSpectrum bare = fresnel_schlick(cos_theta, f0, 1);
        if (film_share == 0) return bare;
        return lerp(film_share, bare, film.reflectance(cos_theta, ior_from_reflectance(f0)));
    }
    SampledSpectrum bound(SampledSpectrum f0) const {
        return film_share > 0 ? lerp(film_share, f0, film.schlick_bound(ior_from_reflectance(f0))) : f0;
    }

    // By the cosine on the side with the smaller index, so that it is the same in both directions; 1 for total
    // internal reflection.
    SampledSpectrum clear_reflectance(float cos_theta, bool above) const {
        const float across = above ? eta : 1 / eta;
        if (!thin && across < 1) {
            const float sin2 = std::max(0.0f, 1 - cos_theta * cos_theta) / (across * across);
            if (sin2 >= 1) return SampledSpectrum(1);
            cos_theta = std::sqrt(1 - sin2);
        }
        return dielectric_reflectance(cos_theta);
    }
};

} // namespace montelux
