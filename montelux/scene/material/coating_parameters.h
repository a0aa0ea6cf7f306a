// CoatingParameters: a dielectric interface over a base, and the layer between the two.
#pragma once

#include "montelux/scene/material/parameter.h"

namespace montelux {

// `albedo` and `g` belong to the medium in the layer.
struct CoatingParameters {
    RoughnessParameter roughness{};
    SceneSpectrum eta{1.5f};
    FloatParameter thickness{0.01f};
    SpectrumParameter albedo{};
    FloatParameter g{};
    int max_depth = 10; // interface crossings of one walk
    int sample_count = 1;

    // `prefix` is the interface's, if the base has parameters of the same names.
    template <typename Self, typename Visit>
    static void visit_parameters(Self& c, Visit&& visit, std::string_view prefix) {
        visit({.prefix = prefix, .name = "roughness"}, c.roughness);
        visit({.prefix = prefix, .name = "eta"}, c.eta);
        visit({.name = "thickness", .doc = "Thickness of the layer between interface and base."},
              c.thickness);
        visit({.name = "albedo", .doc = "Single-scattering albedo of the medium in the layer; 0: none."},
              c.albedo);
        visit({.name = "g", .doc = "Mean cosine of the scattering in that medium.", .least = -1, .most = 1},
              c.g);
        visit({.name = "max_depth", .doc = "Interface crossings of one random walk.", .least = 1},
              c.max_depth);
        visit({.name = "sample_count",
               .doc = "Random walks of one evaluation.",
               .least = 1,
               .pbrt = "nsamples"},
              c.sample_count);
    }
};

} // namespace montelux
