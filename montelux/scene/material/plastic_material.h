// PlasticMaterial: a matt base under a clear interface that absorbs nothing.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

// eta and alpha are the same everywhere: SceneTables has a PlasticTable for them.
struct PlasticMaterial {
    static constexpr const char* name = "Plastic";
    static constexpr const char* doc = "A matt base under a clear interface, in closed form.";

    SpectrumParameter reflectance{0.5f};
    SpectrumParameter specular_reflectance{1};
    float eta = 1.5f;
    float alpha = 0;
    MicrofacetDistribution distribution = MicrofacetDistribution::ggx;
    bool nonlinear = false;
    float internal_reflectance = 0;
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "reflectance", .doc = "Reflectance of the base, 0 to 1."}, m.reflectance);
        visit({.name = "specular_reflectance", .doc = "Factor of the reflection by the interface, 0 to 1."},
              m.specular_reflectance);
        visit({.name = "eta", .doc = "Index of refraction.", .least = 1, .most = 100}, m.eta);
        visit({.name = "alpha", .doc = "Roughness of the interface; 0 is a mirror.", .most = 10}, m.alpha);
        visit({.name = "distribution"}, m.distribution);
        visit({.name = "nonlinear", .doc = "Whether reflections under the interface saturate colours."},
              m.nonlinear);
        visit({.name = "internal_reflectance",
               .doc = "Share of the base's light that the interface reflects back; 0: computed from eta and "
                      "alpha.",
               .most = 1},
              m.internal_reflectance);
    }

    PlasticBsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
