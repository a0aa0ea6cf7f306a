// ConductorMaterial: a metal.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct ConductorMaterial {
    static constexpr const char* name = "Conductor";
    static constexpr const char* doc = "A metal.";

    MetalParameter metal{};
    RoughnessParameter roughness{};
    SpectrumParameter specular_reflectance{1};
    MicrofacetDistribution distribution = MicrofacetDistribution::ggx;
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "metal"}, m.metal);
        visit({.name = "roughness"}, m.roughness);
        visit(
            {.name = "specular_reflectance", .doc = "Factor of the reflected light, 0 to 1.", .added = true},
            m.specular_reflectance);
        visit({.name = "distribution", .added = true}, m.distribution);
    }

    Bsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
