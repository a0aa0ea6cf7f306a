// SunLight: the disc of the sun.
#pragma once

#include "montelux/scene/light/light_model.h"
#include "montelux/scene/light/sky/sun_disc.h"
#include "montelux/scene/scene_spectrum.h"

namespace montelux {

// Uniform radiance scale * spectrum over the disc.
struct SunLight {
    static constexpr LightKind kind = LightKind::infinite;
    static constexpr std::string_view name = "sun";

    SceneSpectrum spectrum;
    float scale = 1;
    SunDisc disc;
    Vec3f up{0, 0, 1};       // the part of the disc on the other side is hidden
    Index motion = no_index; // MovableLight

    bool hides(Vec3f wi) const { return dot(wi, up) < 0; }

    SunLight moved(const Transform& world_from_own) const;

    MONTELUX_LIGHT_MODEL;
};
static_assert(MovableLight<SunLight>);

} // namespace montelux
