// How light sampling and scattering share the light of a path, by the settings of an integrator.
#pragma once

#include "montelux/mc/integrate/mis.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

inline bool samples_lights(const IntegratorSettings& settings) {
    return settings.strategy >= Strategy::light;
}

// MIS weight of the strategy with density f against the one with density g.
template <Number T>
T path_weight(const IntegratorSettings& settings, T f, T g) {
    return settings.heuristic == Heuristic::power ? power_heuristic(1, f, 1, g)
                                                  : balance_heuristic(1, f, 1, g);
}

// The density of one strategy that weighs as much as two.
inline float joint_density(const IntegratorSettings& settings, float f, float g) {
    if (g == 0) return f; // the usual case, which need not pay for the root
    return settings.heuristic == Heuristic::power ? power_joint_pdf(f, g) : balance_joint_pdf(f, g);
}

// MIS weight of light that a path hit after scattering with density `scatter_pdf`.
inline float hit_weight(const IntegratorSettings& settings, float scatter_pdf, float light_pdf) {
    if (!samples_lights(settings)) return 1;
    if (settings.strategy == Strategy::light) return light_pdf > 0 ? 0.0f : 1.0f;
    return path_weight(settings, scatter_pdf, light_pdf);
}

} // namespace montelux
