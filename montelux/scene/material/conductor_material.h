// ConductorMaterial: a metal.
#pragma once

#include "montelux/scene/bsdf/conductor.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct ConductorMaterial {
    static constexpr const char* name = "Conductor";
    static constexpr const char* doc = "A metal.";

    MetalParameter metal{};
    RoughnessParameter roughness{};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "metal"}, m.metal);
        visit({.name = "roughness"}, m.roughness);
    }

    template <typename Evaluator>
    ConductorBsdf bsdf(const Evaluator& at) const {
        return at.conductor(metal, roughness, 1);
    }
};

} // namespace montelux
