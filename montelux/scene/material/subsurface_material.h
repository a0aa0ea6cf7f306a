// SubsurfaceMaterial: the surface of a translucent body such as skin, marble or milk.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

// Shapes with it have `interior` inside (Shape::media), a medium whose scattering is part of one event of a path.
struct SubsurfaceMaterial {
    static constexpr const char* name = "Subsurface";
    static constexpr const char* doc =
        "The surface of a translucent body. Its interior is read from scene files, and is kept.";

    float eta = 1.33f;
    RoughnessParameter roughness{};
    MediumIndex interior{};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "eta", .doc = "Index of refraction.", .least = 1, .most = 100}, m.eta);
        visit({.name = "roughness"}, m.roughness);
        visit({.name = "interior"}, m.interior);
    }

    SubsurfaceBsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
