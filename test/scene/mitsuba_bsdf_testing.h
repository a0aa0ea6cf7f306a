// BSDFs with the formulas of Mitsuba, to test.
#pragma once

#include "test/scene/bsdf_case.h"
#include <map>
#include <utility>
#include <vector>

namespace montelux::testing {

inline const PlasticTable& plastic_table(float alpha, NormalDistribution distribution) {
    static std::map<std::pair<float, NormalDistribution>, PlasticTable> tables;
    return tables.try_emplace({alpha, distribution}, 1.5f, alpha, distribution).first->second;
}

inline PlasticBsdf plastic(float alpha, NormalDistribution distribution, SampledSpectrum rho,
                           bool nonlinear = false) {
    const PlasticTable& table = plastic_table(alpha, distribution);
    return {&table, {{alpha, alpha}, distribution}, table.base_albedo(rho, nonlinear), SampledSpectrum(1)};
}

// With all lobes; the share `clear` of the dielectric refracts.
inline DisneySolid disney_solid(float clear) {
    constexpr float metallic = 0.3f;
    const SampledSpectrum color(0.3f, 0.4f, 0.5f, 0.6f);
    DisneySolid l;
    l.base = {((1 - metallic) * (1 - clear)) * color, SampledSpectrum(0.2f), 0.6f, 0.5f};
    l.normals = {{0.5f, 0.3f}, NormalDistribution::ggx_separable};
    l.metallic = metallic;
    l.transmitting = (1 - metallic) * clear;
    l.tinted = 0.4f;
    l.color = color;
    l.tinted_f0 = 0.04f * color;
    l.coat = 0.8f;
    l.coat_alpha = 0.1f;
    return l;
}

inline DisneySheet disney_sheet() {
    const SampledSpectrum color(0.3f, 0.4f, 0.5f, 0.6f);
    DisneySheet l;
    l.base = {0.3f * color, SampledSpectrum(0.2f), 0.6f, 0.5f};
    l.reflecting = {{0.5f, 0.3f}, NormalDistribution::ggx_separable};
    l.crossing = {{0.3f, 0.2f}, NormalDistribution::ggx_separable};
    l.clear = 0.4f;
    l.tinted = 0.4f;
    l.color = color;
    l.tinted_f0 = 0.04f * color;
    l.transmitting = 0.3f * color;
    return l;
}

// Added to the cases of bsdf_testing.h.
inline std::vector<BsdfCase> mitsuba_cases() {
    const SampledSpectrum eta(0.2f, 0.4f, 0.9f, 1.1f), k(3.9f, 3.0f, 2.4f, 2.1f);
    const NormalDistribution beckmann = NormalDistribution::beckmann;
    const auto tinted_conductor = [=](Ggx alpha, NormalDistribution d) {
        return TintedConductorBsdf{{eta, k, {alpha, d}}, SampledSpectrum(0.5f, 0.7f, 0.9f, 1.0f)};
    };
    const auto tinted_dielectric = [](Ggx alpha, NormalDistribution d) {
        return TintedDielectricBsdf{{1.5f, {alpha, d}},
                                    SampledSpectrum(0.5f, 0.7f, 0.9f, 1.0f),
                                    SampledSpectrum(1, 0.8f, 0.6f, 0.4f)};
    };
    return {
        {"beckmann_conductor_0_1",
         [=] {
             return tinted_conductor({0.1f, 0.1f}, beckmann);
         }},
        {"beckmann_conductor_0_5",
         [=] {
             return tinted_conductor({0.5f, 0.5f}, beckmann);
         }},
        {"beckmann_conductor_anisotropic",
         [=] {
             return tinted_conductor({0.8f, 0.2f}, beckmann);
         }},
        {"separable_conductor",
         [=] {
             return tinted_conductor({0.3f, 0.6f}, NormalDistribution::ggx_separable);
         }},
        {"beckmann_dielectric_0_2",
         [=] {
             return tinted_dielectric({0.2f, 0.2f}, beckmann);
         }},
        {"beckmann_dielectric_anisotropic",
         [=] {
             return tinted_dielectric({0.3f, 0.7f}, beckmann);
         }},
        {"tinted_dielectric_smooth",
         [=] {
             return tinted_dielectric({0, 0}, beckmann);
         }},
        {"tinted_thin_dielectric",
         [=] {
             return TintedThinDielectricBsdf{{1.5f}, SampledSpectrum(0.3f), SampledSpectrum(0.8f)};
         }},
        {"tinted_dielectric_tilted",
         [=] {
             return TiltedBsdf{tinted_dielectric({0.4f, 0.4f}, NormalDistribution::ggx_separable),
                               direction(25, 200)};
         }},
        {"plastic_smooth", [=] { return plastic(0, beckmann, SampledSpectrum(0.2f, 0.4f, 0.6f, 0.8f)); }},
        {"plastic_beckmann_0_1", [=] { return plastic(0.1f, beckmann, SampledSpectrum(0.9f)); }},
        {"plastic_beckmann_0_5", [=] { return plastic(0.5f, beckmann, SampledSpectrum(0.5f), true); }},
        {"plastic_separable",
         [=] { return plastic(0.3f, NormalDistribution::ggx_separable, SampledSpectrum(1)); }},
        {"plastic_dark", [=] { return plastic(0.2f, NormalDistribution::ggx, SampledSpectrum(0.1f)); }},
        {"disney", [=] { return DisneyOpaqueBsdf{disney_solid(0)}; }, true, true, true},
        {"disney_glass", [=] { return DisneySolidBsdf{disney_solid(0.7f)}; }},
        {"disney_sheet", [=] { return DisneySheetBsdf{disney_sheet()}; }, true, false},
    };
}

} // namespace montelux::testing
