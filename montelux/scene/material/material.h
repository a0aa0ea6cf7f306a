// Materials: how the parameters of a BSDF vary over a surface. Evaluated at a point they give a Bsdf.
#pragma once

#include <variant>

#include "montelux/scene/texture/texture.h"

namespace montelux {

// GGX roughness along u and v. With `remap`, alpha = sqrt(roughness); else the parameter is alpha itself.
struct RoughnessParameter {
    FloatParameter u, v;
    bool remap = true;
};

struct DiffuseMaterial {
    SpectrumParameter reflectance;
};
// Either the complex index of refraction eta + ik, or `reflectance` at normal incidence (then k is found for
// eta = 1).
struct ConductorMaterial {
    SpectrumParameter eta, k;
    SpectrumParameter reflectance;
    bool from_reflectance = false;
    RoughnessParameter roughness;
};
struct DielectricMaterial {
    Spectrum eta;
    RoughnessParameter roughness;
};
struct ThinDielectricMaterial {
    Spectrum eta;
};
// The layer between a dielectric interface and the base; `albedo` and `g` are of the medium that fills it.
struct CoatingParameters {
    RoughnessParameter roughness;
    Spectrum eta;
    FloatParameter thickness{0.01f};
    SpectrumParameter albedo;
    FloatParameter g;
    int max_depth = 10; // interface crossings of one walk
    int sample_count = 1;
};
struct CoatedDiffuseMaterial {
    SpectrumParameter reflectance;
    CoatingParameters coating;
    Index albedo_table =
        no_index; // into Scene::coating_tables, filled by Scene::prepare where the closed form holds
};
struct CoatedConductorMaterial {
    ConductorMaterial conductor;
    CoatingParameters coating;
};

using Material = std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial, ThinDielectricMaterial,
                              CoatedDiffuseMaterial, CoatedConductorMaterial>;

} // namespace montelux
