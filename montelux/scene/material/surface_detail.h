// SurfaceDetail: bumps and normal map of any material.
#pragma once

#include "montelux/scene/material/parameter.h"

namespace montelux {

class ParameterEvaluator;

struct SurfaceDetail {
    // Height above the surface in units of length. A texture gives bumps; a constant has no effect.
    FloatParameter displacement{};
    NormalMapParameter normal_map{};
    // As in Mitsuba: light fades towards the terminator of the tilted surface (Estevez, Lecocq, Stein 2019, "A
    // Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem"), and normals that face away from wo are
    // mirrored at the surface's own, which decides on sides. Bumps are not smoothed over the pixel.
    bool shadowed = false;

    bool is_flat() const { return displacement.is_constant() && !normal_map.is_given(); }

    template <typename Self, typename Visit>
    static void visit_parameters(Self& d, Visit&& visit) {
        visit({.name = "displacement",
               .doc = "Height of bumps above the surface: a texture of numbers.",
               .least = std::numeric_limits<double>::lowest()},
              d.displacement);
        visit({.name = "normal_map", .doc = "Shading normals: a NormalMap, or None."}, d.normal_map);
        visit({.name = "shadowed",
               .doc = "Whether light fades towards the terminator of bumps, as in Mitsuba.",
               .added = true},
              d.shadowed);
    }
};

} // namespace montelux
