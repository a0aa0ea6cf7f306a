// DisneyMaterial: the principled material of Disney Animation.
#pragma once

#include <algorithm>

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

// Parameters and names after Burley 2012 and 2015, as in Mitsuba's plugin `principled`.
struct DisneyMaterial {
    static constexpr const char* name = "Disney";
    static constexpr const char* doc = "The principled material of Disney Animation, of solids.";

    SpectrumParameter base_color{0.5f};
    FloatParameter metallic{};
    FloatParameter roughness{0.5f};
    FloatParameter anisotropic{};
    float eta = 1.5f;
    FloatParameter specular_tint{};
    FloatParameter sheen{}, sheen_tint{};
    FloatParameter flatness{};
    FloatParameter clearcoat{}, clearcoat_gloss{};
    FloatParameter specular_transmission{};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit(
            {.name = "base_color", .doc = "Colour of the diffuse base, of metal and of light that crosses."},
            m.base_color);
        visit({.name = "metallic", .doc = "Share of metal, 0 to 1.", .most = 1}, m.metallic);
        visit({.name = "roughness", .doc = "Square root of GGX's alpha, 0 to 1.", .most = 1}, m.roughness);
        visit({.name = "anisotropic", .doc = "Elongation of highlights, 0 to 1.", .most = 1}, m.anisotropic);
        visit({.name = "eta", .doc = "Index of refraction, inside over outside.", .most = 100}, m.eta);
        visit({.name = "specular_tint", .doc = "Tint of the dielectric's reflection, 0 to 1.", .most = 1},
              m.specular_tint);
        visit({.name = "sheen", .doc = "Reflection at grazing angles, as of cloth."}, m.sheen);
        visit({.name = "sheen_tint", .doc = "Tint of the sheen, 0 to 1.", .most = 1}, m.sheen_tint);
        visit({.name = "flatness", .doc = "Share of fake subsurface scattering, 0 to 1.", .most = 1},
              m.flatness);
        visit({.name = "clearcoat", .doc = "Weight of the clear coat, 0 to 1.", .most = 1}, m.clearcoat);
        visit({.name = "clearcoat_gloss", .doc = "Sharpness of the coat's highlight, 0 to 1.", .most = 1},
              m.clearcoat_gloss);
        visit({.name = "specular_transmission",
               .doc = "Share of the dielectric that refracts, 0 to 1.",
               .most = 1},
              m.specular_transmission);
    }

    bool is_anisotropic() const { return !anisotropic.is_constant() || anisotropic.value != 0; }

    template <typename Evaluator>
    Bsdf bsdf(const Evaluator& at) const {
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
};

// The same of thin sheets, as in Mitsuba's plugin `principledthin`.
struct DisneyThinMaterial {
    static constexpr const char* name = "DisneyThin";
    static constexpr const char* doc = "The principled material of Disney Animation, of thin sheets.";

    SpectrumParameter base_color{0.5f};
    FloatParameter roughness{0.5f};
    FloatParameter anisotropic{};
    FloatParameter eta{1.5f};
    FloatParameter specular_tint{};
    FloatParameter sheen{}, sheen_tint{};
    FloatParameter flatness{};
    FloatParameter specular_transmission{};
    FloatParameter diffuse_transmission{};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "base_color", .doc = "Colour of diffuse light and of light that crosses."},
              m.base_color);
        visit({.name = "roughness", .doc = "Square root of GGX's alpha, 0 to 1.", .most = 1}, m.roughness);
        visit({.name = "anisotropic", .doc = "Elongation of highlights, 0 to 1.", .most = 1}, m.anisotropic);
        visit({.name = "eta", .doc = "Index of refraction.", .most = 100}, m.eta);
        visit({.name = "specular_tint", .doc = "Tint of the reflection, 0 to 1.", .most = 1},
              m.specular_tint);
        visit({.name = "sheen", .doc = "Reflection at grazing angles, as of cloth."}, m.sheen);
        visit({.name = "sheen_tint", .doc = "Tint of the sheen, 0 to 1.", .most = 1}, m.sheen_tint);
        visit({.name = "flatness", .doc = "Share of fake subsurface scattering, 0 to 1.", .most = 1},
              m.flatness);
        visit(
            {.name = "specular_transmission", .doc = "Share of the sheet that is clear, 0 to 1.", .most = 1},
            m.specular_transmission);
        visit({.name = "diffuse_transmission",
               .doc = "Share of the diffuse light that crosses, 0 to 1.",
               .most = 1},
              m.diffuse_transmission);
    }

    bool is_anisotropic() const { return !anisotropic.is_constant() || anisotropic.value != 0; }

    template <typename Evaluator>
    DisneySheetBsdf bsdf(const Evaluator& at) const {
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
};

} // namespace montelux
