// PrincipledMaterial: the layered material of glTF 2.0 and its extensions.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

struct PrincipledInterface;
struct PrincipledLayers;

// Parameters after the glTF 2.0 specification, appendix B, and the Khronos extensions KHR_materials_*.
struct PrincipledMaterial {
    static constexpr const char* name = "Principled";
    static constexpr const char* doc =
        "Metals, plastics, glass, cloth and lacquer by one list of parameters, as in glTF 2.0.";

    SpectrumParameter base_color{1};
    FloatParameter metallic{};
    FloatParameter roughness{0.5f};
    FloatParameter anisotropy{};
    FloatParameter anisotropy_rotation{};
    FloatParameter ior{1.5f};
    FloatParameter specular{1};
    SpectrumParameter specular_color{1};
    FloatParameter transmission{};
    FloatParameter dispersion{};
    FloatParameter diffuse_transmission{};
    SpectrumParameter diffuse_transmission_color{1};
    FloatParameter clearcoat{};
    FloatParameter clearcoat_roughness{};
    NormalMapParameter clearcoat_normal_map{};
    SpectrumParameter sheen_color{};
    FloatParameter sheen_roughness{};
    FloatParameter iridescence{};
    FloatParameter iridescence_ior{1.3f};
    FloatParameter iridescence_thickness{400};
    bool thin_walled = false;
    SurfaceDetail detail{};

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "base_color", .doc = "Reflectance of the diffuse base or the metal; colour of glass."},
              m.base_color);
        visit({.name = "metallic", .doc = "Share of metal, 0 to 1.", .most = 1}, m.metallic);
        visit({.name = "roughness", .doc = "Square root of GGX's alpha, 0 to 1.", .most = 1}, m.roughness);
        visit({.name = "anisotropy", .doc = "Elongation of highlights, 0 to 1.", .most = 1}, m.anisotropy);
        visit({.name = "anisotropy_rotation",
               .doc = "Angle from the tangent to the rougher direction, radians.",
               .least = -1e6},
              m.anisotropy_rotation);
        visit({.name = "ior", .doc = "Index of refraction of the dielectric; 0: infinite."}, m.ior);
        visit({.name = "specular", .doc = "Weight of the dielectric's reflection, 0 to 1.", .most = 1},
              m.specular);
        visit({.name = "specular_color",
               .doc = "Factor of the dielectric's reflectance at normal incidence.",
               .meaning = RgbMeaning::unbounded},
              m.specular_color);
        visit({.name = "transmission", .doc = "Share of the diffuse base that is clear, 0 to 1.", .most = 1},
              m.transmission);
        visit({.name = "dispersion", .doc = "20 divided by the Abbe number; 0: none."}, m.dispersion);
        visit({.name = "diffuse_transmission",
               .doc = "Share of the diffuse base that transmits diffusely, 0 to 1.",
               .most = 1},
              m.diffuse_transmission);
        visit({.name = "diffuse_transmission_color", .doc = "Colour of the diffusely transmitted light."},
              m.diffuse_transmission_color);
        visit({.name = "clearcoat", .doc = "Weight of the clear coat, 0 to 1.", .most = 1}, m.clearcoat);
        visit({.name = "clearcoat_roughness", .doc = "Square root of the coat's alpha, 0 to 1.", .most = 1},
              m.clearcoat_roughness);
        visit({.name = "clearcoat_normal_map",
               .doc =
                   "Normals of the coat: a NormalMap, or None: those of the surface, without the bumps and "
                   "normal map of what lies below.",
               .added = true},
              m.clearcoat_normal_map);
        visit({.name = "sheen_color", .doc = "Reflectance of fibres on the surface; 0: none."},
              m.sheen_color);
        visit({.name = "sheen_roughness", .doc = "Roughness of the sheen, 0 to 1.", .most = 1},
              m.sheen_roughness);
        visit({.name = "iridescence", .doc = "Weight of the thin film, 0 to 1.", .most = 1}, m.iridescence);
        visit({.name = "iridescence_ior", .doc = "Index of refraction of the film.", .least = 1},
              m.iridescence_ior);
        visit({.name = "iridescence_thickness", .doc = "Thickness of the film in nm; 0: none."},
              m.iridescence_thickness);
        visit({.name = "thin_walled", .doc = "A sheet: neither refraction nor a medium behind it."},
              m.thin_walled);
    }

    bool has_coat() const { return !clearcoat.is_constant() || clearcoat.value > 0; }

    // The lobes are turned or elongated along the tangents.
    bool is_anisotropic() const { return !anisotropy.is_constant() || anisotropy.value != 0; }

    Bsdf bsdf(const ParameterEvaluator& at) const;

  private:
    PrincipledLayers evaluated(const ParameterEvaluator& at) const;
    PrincipledInterface evaluated_interface(const ParameterEvaluator& at, SampledSpectrum color, float metal,
                                            float clear) const;

    // KHR_materials_dispersion: Cauchy's equation through the index at 587.6 nm, with the Abbe number
    // 20 / dispersion.
    float dispersed(const ParameterEvaluator& at, float n) const;
};

} // namespace montelux
