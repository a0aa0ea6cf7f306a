// ThinDielectricMaterial: a pane of glass.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
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

    Bsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
