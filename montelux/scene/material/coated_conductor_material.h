// CoatedConductorMaterial: a metal under a clear coat.
#pragma once

#include <cmath>

#include "montelux/scene/bsdf/conductor.h"
#include "montelux/scene/bsdf/layered.h"
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

    template <typename Evaluator>
    LayeredBsdf<ConductorBsdf> bsdf(const Evaluator& at) const {
        const float eta = at.refractive_index(coating.eta);
        const ConductorBsdf base = at.conductor(metal, roughness, eta);
        const Ggx coat = at.roughness(coating.roughness);
        // Light crosses the coat twice: the widths of the lobes add.
        auto widen = [](float a, float b) { return std::max(std::sqrt(a * a + 2 * b * b), 2e-3f); };
        const Ggx proxy{widen(base.normals.alpha_x, coat.alpha_x), widen(base.normals.alpha_y, coat.alpha_y)};
        return at.layered(coating, eta, base, proxy);
    }
};

} // namespace montelux
