// MeasuredMaterial: reflection as measured by a gonio-photometer.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct MeasuredMaterial {
    static constexpr const char* name = "Measured";
    static constexpr const char* doc = "A measured surface, from a file of Dupuy and Jakob's format (.bsdf).";

    MeasuredBrdfIndex brdf{};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "brdf", .doc = "What Scene.measured_brdf() returns.", .pbrt = "filename"}, m.brdf);
    }

    MeasuredBsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
