// HairMaterial: hair and fur, on curves.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

// The surface's u runs along the hair, its v from 0 to 1 across.
struct HairMaterial {
    static constexpr const char* name = "Hair";
    static constexpr const char* doc = "Hair and fur, on curves.";
    static constexpr bool uses_coordinates = true; // even without textures

    HairColorParameter color{};
    FloatParameter eta{1.55f};
    FloatParameter beta_m{0.3f}, beta_n{0.3f};
    FloatParameter alpha{2};
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "color"}, m.color);
        visit({.name = "eta", .doc = "Index of refraction.", .least = 1}, m.eta);
        visit({.name = "beta_m",
               .doc = "Roughness along the hair, 0 to 1.",
               .least = 0,
               .most = 1,
               .pbrt = "beta_m"},
              m.beta_m);
        visit({.name = "beta_n",
               .doc = "Roughness about the hair, 0 to 1.",
               .least = 0,
               .most = 1,
               .pbrt = "beta_n"},
              m.beta_n);
        visit({.name = "alpha", .doc = "Tilt of the scales in degrees.", .least = -90, .most = 90}, m.alpha);
    }

    HairBsdf bsdf(const ParameterEvaluator& at) const;
};

} // namespace montelux
