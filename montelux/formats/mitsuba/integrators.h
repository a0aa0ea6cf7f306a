// Integrators of a Mitsuba scene as settings of ours.
#pragma once

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/scene/render_settings.h"

namespace montelux::mitsuba {

// Scattering events of paths whose length the file does not limit. Russian roulette ends them long before, except in
// closed rooms that absorb nothing.
inline constexpr int unlimited_depth = 10'000;

void read_integrator(Plugin integrator, IntegratorSettings& settings);

} // namespace montelux::mitsuba
