// ThinDielectricMaterial: a pane of glass.
#pragma once

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct ThinDielectricMaterial {
    static constexpr const char* name = "ThinDielectric";
    static constexpr const char* doc = "A thin pane, which does not refract.";

    SceneSpectrum eta{1.5f};
    SpectrumParameter specular_reflectance{1}, specular_transmittance{1};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "eta"}, m.eta);
        visit(
            {.name = "specular_reflectance", .doc = "Factor of the reflected light, 0 to 1.", .added = true},
            m.specular_reflectance);
        visit({.name = "specular_transmittance",
               .doc = "Factor of the transmitted light, 0 to 1.",
               .added = true},
              m.specular_transmittance);
    }

    template <typename Evaluator>
    Bsdf bsdf(const Evaluator& at) const {
        const ThinDielectricBsdf b{at.refractive_index(eta)};
        if (has_no_effect(specular_reflectance) && has_no_effect(specular_transmittance)) return b;
        return TintedThinDielectricBsdf{b, at.reflectance(specular_reflectance),
                                        at.reflectance(specular_transmittance)};
    }
};

} // namespace montelux
