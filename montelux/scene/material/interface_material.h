// InterfaceMaterial: a boundary of media that does not scatter.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

// Paths pass it without a scattering event; so do shadow rays. Its BSDF lets all light straight through, for
// callers that do not know it.
struct InterfaceMaterial {
    static constexpr const char* name = "Interface";
    static constexpr const char* doc = "An invisible boundary of media.";

    SurfaceDetail detail{}; // without effect

    template <typename Self, typename Visit>
    static void visit_parameters(Self&, Visit&&) {}

    ThinDielectricBsdf bsdf(const ParameterEvaluator&) const;
};

} // namespace montelux
