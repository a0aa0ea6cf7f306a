// DielectricMaterial: glass, water.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct DielectricMaterial {
    static constexpr const char* name = "Dielectric";
    static constexpr const char* doc = "Glass, water: refracts and reflects.";

    SceneSpectrum eta{1.5f};
    RoughnessParameter roughness{};
    SpectrumParameter specular_reflectance{1}, specular_transmittance{1};
    MicrofacetDistribution distribution = MicrofacetDistribution::ggx;
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "eta"}, m.eta);
        visit({.name = "roughness"}, m.roughness);
        visit(
            {.name = "specular_reflectance", .doc = "Factor of the reflected light, 0 to 1.", .added = true},
            m.specular_reflectance);
        visit({.name = "specular_transmittance",
               .doc = "Factor of the transmitted light, 0 to 1.",
               .added = true},
              m.specular_transmittance);
        visit({.name = "distribution", .added = true}, m.distribution);
    }

    Bsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
