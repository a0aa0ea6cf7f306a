// ImageInfiniteLight: an environment map, or the part of it that enters through a portal.
#pragma once

#include "montelux/mc/math/transform.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/scene/light/light_model.h"
#include "montelux/scene/light/portal.h"

namespace montelux {

// Radiance from a map of illuminants in linear sRGB, interpolated as in EnvironmentSettings; with a portal,
// only through it.
struct ImageInfiniteLight {
    static constexpr LightKind kind = LightKind::infinite;
    static constexpr std::string_view name = "environment map";

    Index environment = no_index; // into Scene::environments
    EnvironmentLayout layout = EnvironmentLayout::equal_area;
    float scale = 1;
    Transform world_from_light;
    std::optional<Portal> portal{};
    Index motion = no_index; // MovableLight; none with a portal

    ImageInfiniteLight moved(const Transform& world_from_own) const;

    MONTELUX_LIGHT_MODEL;
};
static_assert(MovableLight<ImageInfiniteLight>);

} // namespace montelux
