// DiffuseMaterial: Lambert's matt surface.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct DiffuseMaterial {
    static constexpr const char* name = "Diffuse";
    static constexpr const char* doc = "Lambert's matt surface.";

    SpectrumParameter reflectance{0.5f};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "reflectance", .doc = "Reflectance, 0 to 1: number, R, G, B, Spectrum or texture."},
              m.reflectance);
    }

    DiffuseBsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
