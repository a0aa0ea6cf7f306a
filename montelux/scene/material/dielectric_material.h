// DielectricMaterial: glass, water.
#pragma once

#include "montelux/scene/bsdf/dielectric.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct DielectricMaterial {
    static constexpr const char* name = "Dielectric";
    static constexpr const char* doc = "Glass, water: refracts and reflects.";

    SceneSpectrum eta{1.5f};
    RoughnessParameter roughness{};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "eta"}, m.eta);
        visit({.name = "roughness"}, m.roughness);
    }

    template <typename Evaluator>
    DielectricBsdf bsdf(const Evaluator& at) const {
        return {at.refractive_index(eta), at.roughness(roughness)};
    }
};

} // namespace montelux
