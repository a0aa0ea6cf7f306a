// ThinDielectricMaterial: a pane of glass.
#pragma once

#include "montelux/scene/bsdf/thin_dielectric.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct ThinDielectricMaterial {
    static constexpr const char* name = "ThinDielectric";
    static constexpr const char* doc = "A thin pane, which does not refract.";

    SceneSpectrum eta{1.5f};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "eta"}, m.eta);
    }

    template <typename Evaluator>
    ThinDielectricBsdf bsdf(const Evaluator& at) const {
        return {at.refractive_index(eta)};
    }
};

} // namespace montelux
