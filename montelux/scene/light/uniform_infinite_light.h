// A sky of one radiance, or the part of it that comes through a portal.
#pragma once

#include "montelux/scene/light/light_model.h"
#include "montelux/scene/light/portal.h"
#include "montelux/spectrum/spectrum.h"

namespace montelux {

// Radiance scale * spectrum from everywhere outside the scene, or through a portal alone.
struct UniformInfiniteLight {
    static constexpr LightKind kind = LightKind::infinite;
    static constexpr std::string_view name = "uniform sky";

    Spectrum spectrum;
    float scale = 1;
    std::optional<Portal> portal{};

    MONTELUX_LIGHT_MODEL;
};
static_assert(LightModel<UniformInfiniteLight>);

} // namespace montelux
