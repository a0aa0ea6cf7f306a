// ParameterInfo: name, range and documentation of a material's parameter; the kinds of parameters.
#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "montelux/scene/bsdf/microfacet_distribution.h"
#include "montelux/scene/texture/texture.h"

namespace montelux {

// A material lists its parameters once, in a function visit_parameters(material, visit) that calls
// visit(info, field) for each. A field is a SceneSpectrum (an index of refraction), SpectrumParameter,
// FloatParameter, float, int, bool, MicrofacetDistribution, or one of the kinds below. The list defines the readers of scene files, the
// Python attributes, the hash, and whether the material is textured.
struct ParameterInfo {
    std::string_view prefix{}; // of the parameter's part of the material; may be empty
    std::string_view name{};   // as in Python
    const char* doc = "";
    RgbMeaning meaning = RgbMeaning::albedo; // of R, G, B given for a spectrum
    // Of numbers and integers; readers refuse others. Not of textures: a material limits their values itself.
    double least = 0, most = std::numeric_limits<double>::max();
    std::string_view pbrt{}; // if not the name without '_'
    // Part of a scene's digest only where it has an effect (has_no_effect below): checkpoints made before the material
    // had the parameter stay valid.
    bool added = false;

    // conductor_eta
    std::string python_name() const {
        return prefix.empty() ? std::string(name) : std::string(prefix) + '_' + std::string(name);
    }
    // conductor.eta
    std::string pbrt_name() const {
        std::string result = prefix.empty() ? std::string() : std::string(prefix) + '.';
        if (!pbrt.empty()) return result.append(pbrt);
        for (char c : name)
            if (c != '_') result += c;
        return result;
    }
};

// GGX roughness along u and v. With `remap`, alpha = sqrt(roughness); else the parameter is alpha itself.
struct RoughnessParameter {
    FloatParameter u{}, v{};
    bool remap = true;

    bool is_anisotropic() const { return u.texture != v.texture || (u.is_constant() && u.value != v.value); }
};

// Either the complex index of refraction eta + ik, or `reflectance` at normal incidence (then eta = 1, and k
// is computed).
struct MetalParameter {
    // The metal of scene files that name none: copper. Its spectra need a scene (default_material).
    static constexpr std::string_view default_eta = "metal-Cu-eta", default_k = "metal-Cu-k";

    // Grey: aluminium at 550 nm.
    SpectrumParameter eta{0.96f}, k{6.69f};
    SpectrumParameter reflectance{};
    bool from_reflectance = false;
};

// Shading normals as R, G, B = (n + 1) / 2 along dp/du, dp/dv and the normal.
struct NormalMapParameter {
    Index map = no_index; // into Scene::normal_maps

    bool is_given() const { return map != no_index; }
};

// The measurements of a surface.
struct MeasuredBrdfIndex {
    Index index = no_index; // into Scene::measured_brdfs

    bool is_given() const { return index != no_index; }
};

// The medium below a surface.
struct MediumIndex {
    Index index = no_index; // into Scene::media

    bool is_given() const { return index != no_index; }
};

// Another material of the scene.
struct MaterialIndex {
    Index index = no_index; // into Scene::materials

    bool is_given() const { return index != no_index; }
};
struct MixedMaterials {
    MaterialIndex first, second;
};
// The material of one side of a surface; if none is given, the side is black.
struct MaterialOfSide {
    Index index = no_index; // into Scene::materials

    bool is_given() const { return index != no_index; }
};

// Absorption inside hair: given itself, or computed from the reflectance of many hairs, or from the
// concentrations of the two melanins.
struct HairColorParameter {
    enum Source : int { melanins, absorption, reflectances };

    SpectrumParameter sigma_a{}, reflectance{};
    FloatParameter eumelanin{1.3f}, pheomelanin{};
    int source = melanins;
};

// Values of parameters that are ParameterInfo::added, if a material with them is as one without the parameter.
inline bool has_no_effect(const SpectrumParameter& factor) {
    return factor.is_constant() && factor.value.is_constant() && factor.value.constant == 1;
}
inline bool has_no_effect(bool flag) { return !flag; }
inline bool has_no_effect(MicrofacetDistribution d) { return d == MicrofacetDistribution::ggx; }

// The simple fields of a parameter: visit(name, field) of SceneSpectrum, SpectrumParameter, FloatParameter,
// float, int, bool, MicrofacetDistribution, NormalMapParameter, MeasuredBrdfIndex, MediumIndex, MaterialIndex or
// MaterialOfSide.
template <typename Field, typename Visit>
void visit_leaves(std::string_view name, Field& field, Visit&& visit) {
    if constexpr (requires { field.remap; }) {
        visit("roughness_u", field.u);
        visit("roughness_v", field.v);
        visit("remap_roughness", field.remap);
    } else if constexpr (requires { field.from_reflectance; }) {
        visit("eta", field.eta);
        visit("k", field.k);
        visit("reflectance", field.reflectance);
        visit("from_reflectance", field.from_reflectance);
    } else if constexpr (requires { field.eumelanin; }) {
        visit("sigma_a", field.sigma_a);
        visit("reflectance", field.reflectance);
        visit("eumelanin", field.eumelanin);
        visit("pheomelanin", field.pheomelanin);
        visit("source", field.source);
    } else if constexpr (requires { field.second.index; }) {
        visit("first", field.first);
        visit("second", field.second);
    } else {
        visit(name, field);
    }
}

} // namespace montelux
