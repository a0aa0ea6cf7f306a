// CoatedDiffuseMaterial: a matt surface under a clear coat.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/coating_parameters.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct CoatedDiffuseMaterial {
    static constexpr const char* name = "CoatedDiffuse";
    static constexpr const char* doc = "A matt surface under a clear coat.";

    SpectrumParameter reflectance{0.5f};
    CoatingParameters coating{};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "reflectance", .doc = "Reflectance of the base, 0 to 1."}, m.reflectance);
        CoatingParameters::visit_parameters(m.coating, visit, "");
    }

    Bsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
