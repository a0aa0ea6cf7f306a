// A clear sky without the disc of the sun.
#pragma once

#include "montelux/mc/math/transform.h"
#include "montelux/scene/light/light_model.h"

namespace montelux {

// The sky and the ground below it. The model gives the radiance; the map only serves to sample directions.
struct SkyLight {
    static constexpr LightKind kind = LightKind::infinite;
    static constexpr std::string_view name = "sky";

    Index sky = no_index;         // into Scene::skies
    Index environment = no_index; // into Scene::environments: its sky_density_map
    float scale = 1;
    Transform world_from_light; // +z is up there
    Index motion = no_index;    // MovableLight

    SkyLight moved(const Transform& world_from_own) const;

    MONTELUX_LIGHT_MODEL;
};
static_assert(MovableLight<SkyLight>);

} // namespace montelux
