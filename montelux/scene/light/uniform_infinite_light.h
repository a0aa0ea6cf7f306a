// UniformInfiniteLight: constant radiance from all directions, or through a portal.
#pragma once

#include "montelux/scene/light/light_model.h"
#include "montelux/scene/light/portal.h"
#include "montelux/scene/scene_spectrum.h"

namespace montelux {

// Radiance scale * spectrum from everywhere outside the scene, or only through a portal.
struct UniformInfiniteLight {
    static constexpr LightKind kind = LightKind::infinite;
    static constexpr std::string_view name = "uniform sky";

    SceneSpectrum spectrum;
    float scale = 1;
    std::optional<Portal> portal{};

    MONTELUX_LIGHT_MODEL;
};
static_assert(LightModel<UniformInfiniteLight>);

} // namespace montelux
