// DistantLight: parallel light from infinity.
#pragma once

#include "montelux/scene/light/light_model.h"
#include "montelux/scene/scene_spectrum.h"

namespace montelux {

// Irradiance scale * spectrum, W/(m^2 nm), on a plane across the beam; light travels along -to_light.
struct DistantLight {
    static constexpr LightKind kind = LightKind::direction;
    static constexpr std::string_view name = "distant light";

    SceneSpectrum spectrum;
    float scale = 1;
    Vec3f to_light{0, 0, 1};
    Index motion = no_index; // MovableLight

    DistantLight moved(const Transform& world_from_own) const;

    MONTELUX_LIGHT_MODEL;
};
static_assert(MovableLight<DistantLight>);

} // namespace montelux
