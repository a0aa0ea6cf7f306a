// Light sources as plain values. Spectra are already scaled so that radiance is in the units of the film.
#pragma once

#include <optional>
#include <variant>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/index.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/scene/light/portal.h"
#include "montelux/scene/light/sky/sun_disc.h"
#include "montelux/spectrum/spectrum.h"

namespace montelux {

// Emits `scale * spectrum` radiance from the front (or both sides) of one primitive of a shape.
struct AreaLight {
    Spectrum spectrum;
    float scale = 1;
    bool two_sided = false;
    Index shape = no_index;
    Index primitive = 0;
};
// Radiant intensity scale * spectrum from one point.
struct PointLight {
    Spectrum spectrum;
    float scale = 1;
    Point3f position;
};
// A cone: full intensity within cos_falloff_start of the axis, smoothstep to zero at cos_total_width.
struct SpotLight {
    Spectrum spectrum;
    float scale = 1;
    Point3f position;
    Vec3f axis{0, 0, 1};
    float cos_falloff_start = 1, cos_total_width = 1;
};
// Irradiance scale * spectrum on a plane orthogonal to the beam; light travels along -to_light.
struct DistantLight {
    Spectrum spectrum;
    float scale = 1;
    Vec3f to_light{0, 0, 1};
};
// The same radiance from everywhere outside the scene, or through a portal alone.
struct UniformInfiniteLight {
    Spectrum spectrum;
    float scale = 1;
    std::optional<Portal> portal{};
};
// Radiance from a map of illuminants in linear sRGB, looked up as EnvironmentSettings say; with a portal,
// through it alone.
struct ImageInfiniteLight {
    Index environment = no_index; // into Scene::environments
    EnvironmentLayout layout = EnvironmentLayout::equal_area;
    float scale = 1;
    Transform world_from_light;
    std::optional<Portal> portal{};
};
// A clear sky and the ground below it, without the sun's disc. Radiance is the model's; the map is there to
// draw directions by.
struct SkyLight {
    Index sky = no_index;         // into Scene::skies
    Index environment = no_index; // into Scene::environments: its sky_density_map
    float scale = 1;
    Transform world_from_light; // +z is up there
};
// The disc of the sun, which shines with the same radiance all over.
struct SunLight {
    Spectrum spectrum;
    float scale = 1;
    SunDisc disc;
    Vec3f up{0, 0, 1}; // the part of the disc that is not on this side is hidden
};

using Light = std::variant<AreaLight, PointLight, SpotLight, DistantLight, UniformInfiniteLight,
                           ImageInfiniteLight, SkyLight, SunLight>;

} // namespace montelux
