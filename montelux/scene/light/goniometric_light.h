// GoniometricLight: a point light whose intensity over directions is a map.
#pragma once

#include "montelux/mc/math/transform.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/scene/light/light_model.h"
#include "montelux/scene/scene_spectrum.h"

namespace montelux {

// Intensity scale * spectrum * map, W/(sr nm), from the origin of the map's space. The map is grey: its first
// channel counts.
struct GoniometricLight {
    static constexpr LightKind kind = LightKind::position;
    static constexpr std::string_view name = "goniometric light";

    SceneSpectrum spectrum;
    float scale = 1;
    Index environment = no_index; // into Scene::environments
    EnvironmentLayout layout = EnvironmentLayout::equal_area;
    Transform world_from_map;
    Index motion = no_index; // MovableLight

    Point3f position() const { return world_from_map.point(Vec3f()); }

    GoniometricLight moved(const Transform& world_from_own) const;

    MONTELUX_LIGHT_MODEL;
};
static_assert(MovableLight<GoniometricLight>);

} // namespace montelux
