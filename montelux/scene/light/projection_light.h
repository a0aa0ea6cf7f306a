// ProjectionLight: a point light that projects a picture.
#pragma once

#include "montelux/mc/math/transform.h"
#include "montelux/scene/light/light_model.h"
#include "montelux/scene/light/projection_table.h"

namespace montelux {

// Intensity scale * the colours of the picture under the white illuminant, W/(sr nm), from the origin of the
// light's space along its z axis (ProjectionScreen), by the profile; none beside the picture.
struct ProjectionLight {
    static constexpr LightKind kind = LightKind::position;
    static constexpr std::string_view name = "projection light";

    Index environment = no_index; // into Scene::environments: the picture
    float scale = 1;
    float fov = 90; // degrees, of the shorter side
    Transform world_from_light;
    Index motion = no_index; // MovableLight
    ProjectionProfile profile = ProjectionProfile::intensity;
    // With the profile `irradiance`; white of the picture may be the constant spectrum 1.
    bool equal_energy = false;
    PictureLookup picture_lookup = PictureLookup::bilinear;

    Point3f position() const { return world_from_light.point(Vec3f()); }

    ProjectionLight moved(const Transform& world_from_own) const;

    MONTELUX_LIGHT_MODEL;
};
static_assert(MovableLight<ProjectionLight>);

} // namespace montelux
