// SpotLight: a point light that emits into a cone.
#pragma once

#include <cstdint>

#include "montelux/scene/light/light_model.h"
#include "montelux/scene/light/picture_lookup.h"
#include "montelux/scene/scene_spectrum.h"

namespace montelux {

// How the intensity falls from one cone to the other.
enum class SpotFalloff : std::uint8_t {
    smooth, // a smoothstep of the cosine
    linear, // linear in the angle
};

// Intensity scale * spectrum, W/(sr nm), within cos_falloff_start of the axis; from there it falls to zero at
// cos_total_width.
struct SpotLight {
    static constexpr LightKind kind = LightKind::position;
    static constexpr std::string_view name = "spot light";

    SceneSpectrum spectrum;
    float scale = 1;
    Point3f position;
    Vec3f axis{0, 0, 1};
    float cos_falloff_start = 1, cos_total_width = 1;
    Index motion = no_index; // MovableLight
    SpotFalloff profile = SpotFalloff::smooth;
    // If given, into Scene::environments: the intensity is multiplied by the colours of this picture, as reflectances
    // of surfaces. Its column and row along w, as shares of its width and height, are
    // 1/2 + (dot(w, picture_x), dot(w, picture_y)) / (2 dot(w, axis)).
    Index picture = no_index;
    PictureLookup picture_lookup = PictureLookup::bilinear;
    Vec3f picture_x{}, picture_y{};

    // Share of the intensity along the unit vector w.
    float falloff(Vec3f w) const;

    // Intensity along the unit vector w.
    SampledSpectrum intensity(const LightContext& context, Vec3f w, const SampledWavelengths& lambda) const;

    SpotLight moved(const Transform& world_from_own) const;

    MONTELUX_LIGHT_MODEL;
};
static_assert(MovableLight<SpotLight>);

} // namespace montelux
