// DisneyMaterial: the principled material of Disney Animation.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
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

    Bsdf bsdf(const ParameterEvaluator& at) const;
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

    DisneySheetBsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
