// BSDFs to test, and streams of random numbers for them.
#pragma once

#include "test/scene/bsdf_case.h"
#include "test/scene/measured_brdf_testing.h"
#include "test/scene/mitsuba_bsdf_testing.h"
#include "test/scene/principled_testing.h"
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/bsdf/multiple_scattering.h"

namespace montelux::testing {

// Numbers are drawn in sequence, for pairs as well.
class TestStream {
  public:
    explicit TestStream(std::uint64_t seed) : uniforms_(seed) {}
    float next_1d() { return uniforms_.next_float(); }
    Vec2f next_2d() { return uniforms_.next_2f(); }

  private:
    TestUniforms uniforms_;
};

// The first numbers are prescribed.
class FixedStream {
  public:
    FixedStream(Vec2f u, float uc) : u_(u), uc_(uc) {}
    float next_1d() const { return uc_; }
    Vec2f next_2d() const { return u_; }

  private:
    Vec2f u_;
    float uc_;
};

inline const CoatingTable& coating_table(float alpha) {
    static std::map<float, CoatingTable> tables;
    return tables.try_emplace(alpha, 1.5f, alpha, 0.01f, 10).first->second;
}

inline CoatedDiffuseBsdf coated_diffuse(float alpha, float rho) {
    const CoatingTable& table = coating_table(alpha);
    return {&table, table.base_albedo(SampledSpectrum(rho))};
}

inline LayeredBsdf<DiffuseBsdf> layered_diffuse(float alpha, float rho) {
    LayeredBsdf<DiffuseBsdf> b;
    b.coat = {1.5f, {alpha, alpha}};
    b.base = {SampledSpectrum(rho)};
    b.proxy = {0.7f, 0.7f};
    return b;
}

inline LayeredBsdf<ConductorBsdf> layered_conductor(float coat_alpha, float base_alpha) {
    LayeredBsdf<ConductorBsdf> b;
    b.coat = {1.5f, {coat_alpha, coat_alpha}};
    b.base = {SampledSpectrum(0.2f, 0.4f, 0.9f, 1.1f),
              SampledSpectrum(3.9f, 3.0f, 2.4f, 2.1f),
              {base_alpha, base_alpha}};
    b.proxy = {std::max(base_alpha, 0.1f), std::max(base_alpha, 0.1f)};
    return b;
}

// With a scattering medium between coat and base.
template <typename Base>
LayeredBsdf<Base> in_fog(LayeredBsdf<Base> b, int max_depth) {
    b.medium_albedo = SampledSpectrum(0.5f, 0.7f, 0.9f, 1.0f);
    b.g = 0.4f;
    b.thickness = 0.7f;
    b.max_depth = max_depth;
    return b;
}

template <typename Base>
LayeredBsdf<Base> cut_at(LayeredBsdf<Base> b, int max_depth) {
    b.max_depth = max_depth;
    return b;
}

template <typename Base>
LayeredBsdf<Base, MultiscatterDielectricBsdf> multiscatter_layers(const auto& single) {
    return std::get<LayeredBsdf<Base, MultiscatterDielectricBsdf>>(with_multiple_scattering(single));
}

inline std::vector<BsdfCase> bsdf_cases() {
    SampledSpectrum eta(0.2f, 0.4f, 0.9f, 1.1f), k(3.9f, 3.0f, 2.4f, 2.1f);
    return {
        {"diffuse", [=] { return DiffuseBsdf{SampledSpectrum(0.2f, 0.4f, 0.6f, 0.8f)}; }},
        {"conductor_smooth",
         [=] {
             return ConductorBsdf{eta, k, {0, 0}};
         }},
        {"conductor_0_1",
         [=] {
             return ConductorBsdf{eta, k, {0.1f, 0.1f}};
         }},
        {"conductor_0_5",
         [=] {
             return ConductorBsdf{eta, k, {0.5f, 0.5f}};
         }},
        {"conductor_anisotropic",
         [=] {
             return ConductorBsdf{eta, k, {0.15f, 0.5f}};
         }},
        {"dielectric_smooth",
         [=] {
             return DielectricBsdf{1.5f, {0, 0}};
         }},
        {"dielectric_0_2",
         [=] {
             return DielectricBsdf{1.5f, {0.2f, 0.2f}};
         }},
        {"dielectric_0_6",
         [=] {
             return DielectricBsdf{1.33f, {0.6f, 0.6f}};
         }},
        {"dielectric_anisotropic",
         [=] {
             return DielectricBsdf{1.8f, {0.2f, 0.5f}};
         }},
        {"dielectric_index_1",
         [=] {
             return DielectricBsdf{1.0f, {0.3f, 0.3f}};
         }},
        {"diffuse_transmission",
         [=] {
             return DiffuseTransmissionBsdf{SampledSpectrum(0.2f, 0.4f, 0.1f, 0.3f),
                                            SampledSpectrum(0.5f, 0.1f, 0.6f, 0.55f)};
         }},
        {"diffuse_transmission_alone",
         [=] {
             return DiffuseTransmissionBsdf{SampledSpectrum(0), SampledSpectrum(0.7f)};
         }},
        {"diffuse_transmission_tilted",
         [=] {
             return TiltedBsdf{DiffuseTransmissionBsdf{SampledSpectrum(0.5f), SampledSpectrum(0.4f)},
                               direction(8, 50)};
         }},
        {"dielectric_tilted",
         [=] {
             return TiltedBsdf{DielectricBsdf{1.5f, {0.3f, 0.3f}}, direction(25, 200)};
         }},
        {"thin_dielectric", [=] { return ThinDielectricBsdf{1.5f}; }},
        {"coated_diffuse_smooth", [=] { return coated_diffuse(0, 0.6f); }},
        {"coated_diffuse_0_1", [=] { return coated_diffuse(0.1f, 0.6f); }},
        {"coated_diffuse_0_4", [=] { return coated_diffuse(0.4f, 0.6f); }},
        {"layered_diffuse_0_4", [=] { return layered_diffuse(0.4f, 0.6f); }, false},
        {"layered_conductor", [=] { return layered_conductor(0.2f, 0.3f); }, false},
        {"layered_conductor_smooth_coat", [=] { return layered_conductor(0, 0.3f); }, false},
        {"layered_conductor_smooth", [=] { return layered_conductor(0, 0); }, false},
        {"layered_diffuse_depth_1", [=] { return cut_at(layered_diffuse(0.4f, 0.6f), 1); }, false},
        {"layered_conductor_depth_3", [=] { return cut_at(layered_conductor(0.2f, 0.3f), 3); }, false},
        {"layered_diffuse_fog", [=] { return in_fog(layered_diffuse(0.4f, 0.6f), 5); }, false},
        {"layered_conductor_fog", [=] { return in_fog(layered_conductor(0.2f, 0.3f), 2); }, false},
        {"layered_conductor_smooth_fog", [=] { return in_fog(layered_conductor(0, 0), 10); }, false},
        // The offset h belongs to wo: light that comes back along a path meets the hair at another one.
        {"hair", [=] { return HairBsdf::make(0.4f, 1.55f, 0.1f * k, 0.3f, 0.3f, 2); }, true, false},
        {"hair_rough", [=] { return HairBsdf::make(-0.8f, 1.4f, 0.1f * eta, 0.9f, 0.8f, 4); }, true, false},
        {"measured",
         [=] {
             return MeasuredBsdf{&measured_case(0.5f, 0.5f), Float4{380, 500, 600, 700}};
         },
         true, false},
        {"measured_anisotropic",
         [=] {
             return MeasuredBsdf{&measured_case(0.3f, 0.6f), Float4{380, 500, 600, 700}};
         },
         true, false},
        {"subsurface",
         [=] {
             return SubsurfaceBsdf::make(1.4f, {0, 0});
         }},
        {"subsurface_rough",
         [=] {
             return SubsurfaceBsdf::make(1.33f, {0.3f, 0.5f});
         }},
        {"multiscatter_conductor",
         [=] {
             return MultiscatterConductorBsdf{{eta, k, {0.6f, 0.6f}}};
         },
         false},
        {"multiscatter_conductor_anisotropic",
         [=] {
             return MultiscatterConductorBsdf{{eta, k, {0.15f, 0.9f}}};
         },
         false},
        {"multiscatter_dielectric",
         [=] {
             return MultiscatterDielectricBsdf{{1.5f, {0.6f, 0.6f}}};
         },
         false},
        {"multiscatter_dielectric_anisotropic",
         [=] {
             return MultiscatterDielectricBsdf{{1.8f, {0.3f, 1.0f}}};
         },
         false},
        {"multiscatter_layered_diffuse",
         [=] { return multiscatter_layers<DiffuseBsdf>(layered_diffuse(0.5f, 0.8f)); }, false},
        {"multiscatter_layered_conductor",
         [=] { return multiscatter_layers<MultiscatterConductorBsdf>(layered_conductor(0.4f, 0.5f)); },
         false},
        {"multiscatter_layered_conductor_fog",
         [=] {
             return multiscatter_layers<MultiscatterConductorBsdf>(in_fog(layered_conductor(0.4f, 0.5f), 6));
         },
         false},
        {"multiscatter_layered_conductor_smooth_coat",
         [=] { return multiscatter_layers<MultiscatterConductorBsdf>(layered_conductor(0, 0.5f)); }, false},
        {"hair_glossy", [=] { return HairBsdf::make(0, 1.55f, 0.1f * eta, 0.15f, 0.2f, 0); }, true, false},
    };
}

// Each lobe of the principled BSDF alone, and mixtures.
inline std::vector<BsdfCase> principled_cases() {
    using M = PrincipledMaterial;
    const auto made = [](const char* name, const M& m) {
        return BsdfCase{std::string("principled_") + name, [=] { return principled(m); }};
    };
    // Not reciprocal, as all normals that are not those of the surface.
    const auto with_tilted_coat = [](const char* name, const M& m) {
        return BsdfCase{std::string("principled_") + name,
                        [=] {
                            Bsdf bsdf = principled(m);
                            std::visit(
                                [&]<typename B>(B& b) {
                                    if constexpr (requires { b.layers; })
                                        b.layers.set_coat_normal(direction(30, 160));
                                },
                                bsdf);
                            return bsdf;
                        },
                        true, false};
    };
    return {
        made("diffuse", M{.base_color = {red_paint}, .specular = {0}}),
        made("plastic", M{.base_color = {red_paint}, .roughness = {0.4f}}),
        made("smooth_plastic", M{.base_color = {red_paint}, .roughness = {0}}),
        made("coloured_highlight",
             M{.base_color = {red_paint}, .ior = {2}, .specular = {0.7f}, .specular_color = {blue_paint}}),
        made("metal", M{.base_color = {red_paint}, .metallic = {1}, .roughness = {0.5f}}),
        made("brushed_metal", M{.base_color = {red_paint},
                                .metallic = {1},
                                .roughness = {0.4f},
                                .anisotropy = {0.7f},
                                .anisotropy_rotation = {0.6f}}),
        made("lacquer", M{.base_color = {blue_paint},
                          .metallic = {0.5f},
                          .roughness = {0.7f},
                          .clearcoat = {1},
                          .clearcoat_roughness = {0.4f}}),
        made("smooth_lacquer", M{.base_color = {red_paint}, .clearcoat = {0.7f}, .clearcoat_roughness = {0}}),
        with_tilted_coat("lacquer_over_waves", M{.base_color = {red_paint},
                                                 .roughness = {0.6f},
                                                 .clearcoat = {1},
                                                 .clearcoat_roughness = {0.5f}}),
        with_tilted_coat("smooth_lacquer_over_waves", M{.base_color = {red_paint}, .clearcoat = {1}}),
        with_tilted_coat("coated_leaf", M{.base_color = {blue_paint},
                                          .diffuse_transmission = {0.5f},
                                          .clearcoat = {1},
                                          .clearcoat_roughness = {0.6f},
                                          .thin_walled = true}),
        made("narrow_fibres", M{.base_color = {0.3f}, .sheen_color = {1}, .sheen_roughness = {0.15f}}),
        made("glass", M{.base_color = {blue_paint}, .roughness = {0.5f}, .transmission = {1}}),
        made("smooth_glass", M{.base_color = {blue_paint}, .roughness = {0}, .transmission = {1}}),
        made("milky_glass", M{.base_color = {blue_paint}, .roughness = {0.5f}, .transmission = {0.6f}}),
        made("brushed_glass",
             M{.roughness = {0.5f}, .anisotropy = {0.6f}, .ior = {1.8f}, .transmission = {1}}),
        made("bubble", M{.roughness = {0.5f}, .ior = {0.7f}, .transmission = {1}}),
        made("index_1",
             M{.base_color = {red_paint}, .roughness = {0.6f}, .ior = {1}, .transmission = {0.7f}}),
        made("pane",
             M{.base_color = {blue_paint}, .roughness = {0.5f}, .transmission = {0.8f}, .thin_walled = true}),
        made("smooth_pane",
             M{.base_color = {blue_paint}, .roughness = {0}, .transmission = {1}, .thin_walled = true}),
        made("leaf", M{.base_color = {blue_paint},
                       .diffuse_transmission = {0.6f},
                       .diffuse_transmission_color = {red_paint},
                       .thin_walled = true}),
        made("wax", M{.base_color = {red_paint},
                      .diffuse_transmission = {0.7f},
                      .diffuse_transmission_color = {red_paint}}),
        made("oiled_plastic",
             M{.base_color = {blue_paint}, .iridescence = {0.8f}, .iridescence_ior = {1.7f}}),
        made("soap", M{.roughness = {0.4f},
                       .transmission = {1},
                       .iridescence = {1},
                       .iridescence_thickness = {700},
                       .thin_walled = true}),
        made("all", M{.base_color = {red_paint},
                      .metallic = {0.3f},
                      .roughness = {0.6f},
                      .anisotropy = {0.5f},
                      .anisotropy_rotation = {-1},
                      .ior = {1.4f},
                      .specular = {0.8f},
                      .specular_color = {blue_paint},
                      .transmission = {0.5f},
                      .diffuse_transmission = {0.4f},
                      .diffuse_transmission_color = {blue_paint},
                      .clearcoat = {0.7f},
                      .clearcoat_roughness = {0.5f},
                      .sheen_color = {blue_paint},
                      .sheen_roughness = {0.4f},
                      .iridescence = {0.5f}}),
        {"principled_tilted",
         [] {
             const Bsdf base =
                 principled(M{.base_color = {red_paint}, .roughness = {0.6f}, .transmission = {0.5f}});
             return TiltedBsdf{std::get<PrincipledBsdf<true>>(base), direction(25, 200)};
         }},
    };
}

// The cases of bsdf_test.cpp.
inline std::vector<BsdfCase> all_bsdf_cases() {
    std::vector<BsdfCase> cases = bsdf_cases();
    for (BsdfCase& c : mitsuba_cases()) cases.push_back(std::move(c));
    for (BsdfCase& c : principled_cases()) cases.push_back(std::move(c));
    return cases;
}

inline std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3f wo, auto& stream,
                                        TransportMode mode = TransportMode::radiance) {
    return std::visit([&](const auto& b) { return b.sample(wo, mode, stream); }, bsdf);
}
inline BsdfEvaluation evaluate(const Bsdf& bsdf, Vec3f wo, Vec3f wi, auto& stream,
                               TransportMode mode = TransportMode::radiance) {
    return std::visit([&](const auto& b) { return b.evaluate(wo, wi, mode, stream); }, bsdf);
}

} // namespace montelux::testing
