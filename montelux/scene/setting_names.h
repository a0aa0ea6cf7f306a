// The names of settings in options, scene files, headers of pictures and Python.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "montelux/scene/bsdf/microfacet_distribution.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

template <typename Setting, std::size_t n>
using SettingNames = std::array<std::pair<std::string_view, Setting>, n>;

inline constexpr SettingNames<SamplerKind, 6> sampler_names{
    {{"independent", SamplerKind::independent},
     {"stratified", SamplerKind::stratified},
     {"halton", SamplerKind::halton},
     {"hammersley", SamplerKind::hammersley},
     {"sobol", SamplerKind::sobol},
     {"sobol-blue-noise", SamplerKind::sobol_blue_noise}}};
inline constexpr SettingNames<IntegratorKind, 5> integrator_names{
    {{"path", IntegratorKind::path},
     {"bidirectional", IntegratorKind::bidirectional},
     {"light-tracing", IntegratorKind::light_tracing},
     {"metropolis", IntegratorKind::metropolis},
     {"auto", IntegratorKind::automatic}}};
inline constexpr SettingNames<Strategy, 6> strategy_names{{{"uniform", Strategy::uniform},
                                                           {"bsdf", Strategy::bsdf},
                                                           {"light", Strategy::light},
                                                           {"mis", Strategy::mis},
                                                           {"mis-bsdf", Strategy::mis_bsdf},
                                                           {"mis-light", Strategy::mis_light}}};
inline constexpr SettingNames<Heuristic, 2> heuristic_names{
    {{"balance", Heuristic::balance}, {"power", Heuristic::power}}};
inline constexpr SettingNames<LightSampling, 3> light_sampling_names{
    {{"tree", LightSampling::tree}, {"power", LightSampling::power}, {"uniform", LightSampling::uniform}}};
inline constexpr SettingNames<Guiding, 3> guiding_names{
    {{"auto", Guiding::automatic}, {"on", Guiding::on}, {"off", Guiding::off}}};
inline constexpr SettingNames<EnvironmentSampling, 4> environment_sampling_names{
    {{"auto", EnvironmentSampling::automatic},
     {"tabulated", EnvironmentSampling::tabulated},
     {"median-cut", EnvironmentSampling::median_cut},
     {"structured", EnvironmentSampling::structured}}};
inline constexpr SettingNames<EnvironmentLookup, 2> environment_lookup_names{
    {{"nearest", EnvironmentLookup::nearest}, {"bilinear", EnvironmentLookup::bilinear}}};
inline constexpr SettingNames<MicrofacetScattering, 2> microfacet_scattering_names{
    {{"single", MicrofacetScattering::single}, {"multiple", MicrofacetScattering::multiple}}};
inline constexpr SettingNames<ShadingTerminator, 2> shading_terminator_names{
    {{"hard", ShadingTerminator::hard}, {"soft", ShadingTerminator::soft}}};
inline constexpr SettingNames<MicrofacetDistribution, 3> normal_distribution_names{
    {{"ggx", MicrofacetDistribution::ggx},
     {"ggx-separable", MicrofacetDistribution::ggx_separable},
     {"beckmann", MicrofacetDistribution::beckmann}}};

template <typename Setting, std::size_t n>
constexpr std::string_view name_in(const SettingNames<Setting, n>& names, Setting value) {
    for (const auto& [name, known] : names)
        if (known == value) return name;
    return "?";
}
constexpr std::string_view name_of(SamplerKind kind) { return name_in(sampler_names, kind); }
constexpr std::string_view name_of(IntegratorKind kind) { return name_in(integrator_names, kind); }
constexpr std::string_view name_of(Strategy strategy) { return name_in(strategy_names, strategy); }
constexpr std::string_view name_of(Heuristic heuristic) { return name_in(heuristic_names, heuristic); }
constexpr std::string_view name_of(LightSampling sampling) { return name_in(light_sampling_names, sampling); }
constexpr std::string_view name_of(Guiding guiding) { return name_in(guiding_names, guiding); }
constexpr std::string_view name_of(EnvironmentSampling sampling) {
    return name_in(environment_sampling_names, sampling);
}
constexpr std::string_view name_of(EnvironmentLookup lookup) {
    return name_in(environment_lookup_names, lookup);
}
constexpr std::string_view name_of(MicrofacetScattering scattering) {
    return name_in(microfacet_scattering_names, scattering);
}
constexpr std::string_view name_of(ShadingTerminator terminator) {
    return name_in(shading_terminator_names, terminator);
}
constexpr std::string_view name_of(MicrofacetDistribution distribution) {
    return name_in(normal_distribution_names, distribution);
}

} // namespace montelux
