// An environment map, or the part of it that comes through a portal.
#pragma once

#include "montelux/mc/math/transform.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/scene/light/light_model.h"
#include "montelux/scene/light/portal.h"

namespace montelux {

// Radiance from a map of illuminants in linear sRGB, looked up as EnvironmentSettings say; with a portal,
// through it alone.
struct ImageInfiniteLight {
    static constexpr LightKind kind = LightKind::infinite;
    static constexpr std::string_view name = "environment map";

    Index environment = no_index; // into Scene::environments
    EnvironmentLayout layout = EnvironmentLayout::equal_area;
    float scale = 1;
    Transform world_from_light;
    std::optional<Portal> portal{};

    MONTELUX_LIGHT_MODEL;
};
static_assert(LightModel<ImageInfiniteLight>);

} // namespace montelux
