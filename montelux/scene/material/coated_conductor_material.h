// CoatedConductorMaterial: a metal under a clear coat.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/coating_parameters.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct CoatedConductorMaterial {
    static constexpr const char* name = "CoatedConductor";
    static constexpr const char* doc = "A metal under a clear coat.";

    MetalParameter metal{};
    RoughnessParameter roughness{}; // of the metal
    CoatingParameters coating{};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.prefix = "conductor", .name = "metal"}, m.metal);
        visit({.prefix = "conductor", .name = "roughness"}, m.roughness);
        CoatingParameters::visit_parameters(m.coating, visit, "interface");
    }

    LayeredBsdf<ConductorBsdf> bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
