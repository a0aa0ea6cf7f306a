// CoatedDiffuseMaterial: a matt surface under a clear coat.
#pragma once

#include "montelux/scene/bsdf/bsdf.h"
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

    template <typename Evaluator>
    Bsdf bsdf(const Evaluator& at) const {
        const SampledSpectrum rho = at.reflectance(reflectance);
        if (const CoatingTable* table = at.coating_table())
            return CoatedDiffuseBsdf{table, table->base_albedo(rho)};
        const float eta = at.refractive_index(coating.eta);
        return at.layered(coating, eta, DiffuseBsdf{rho}, Ggx{0.7f, 0.7f});
    }
};

} // namespace montelux
