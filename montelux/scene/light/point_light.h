// PointLight: a point that emits equally in all directions.
#pragma once

#include "montelux/scene/light/light_model.h"
#include "montelux/scene/scene_spectrum.h"

namespace montelux {

// Radiant intensity scale * spectrum, W/(sr nm).
struct PointLight {
    static constexpr LightKind kind = LightKind::position;
    static constexpr std::string_view name = "point light";

    SceneSpectrum spectrum;
    float scale = 1;
    Point3f position;
    Index motion = no_index; // MovableLight

    PointLight moved(const Transform& world_from_own) const;

    MONTELUX_LIGHT_MODEL;
};
static_assert(MovableLight<PointLight>);

// The sample of a point light with that intensity towards the reference. Empty at the light itself.
std::optional<LightSample> sample_position(Point3f position, SampledSpectrum intensity,
                                           const ReferencePoint& from);

} // namespace montelux
