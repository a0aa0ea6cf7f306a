// DiffuseTransmissionMaterial: a thin matt translucent sheet.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct DiffuseTransmissionMaterial {
    static constexpr const char* name = "DiffuseTransmission";
    static constexpr const char* doc = "A thin matt sheet that light shines through: a leaf, paper, cloth.";

    SpectrumParameter reflectance{0.25f}, transmittance{0.25f};
    float scale = 1; // of both
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "reflectance", .doc = "Share of light that is reflected, 0 to 1."}, m.reflectance);
        visit({.name = "transmittance", .doc = "Share of light that is transmitted, 0 to 1."},
              m.transmittance);
        visit({.name = "scale", .doc = "Factor of reflectance and transmittance."}, m.scale);
    }

    DiffuseTransmissionBsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
