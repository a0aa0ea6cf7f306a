// Light sources as plain values. Spectra are already scaled so that radiance is in the units of the film.
#pragma once

#include <variant>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/index.h"
#include "montelux/scene/light/environment/environment_grid.h"
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
// The same radiance from everywhere outside the scene.
struct UniformInfiniteLight {
    Spectrum spectrum;
    float scale = 1;
};
// Radiance from a map of RGB illuminants, looked up in the nearest texel.
struct ImageInfiniteLight {
    Index environment = no_index; // into Scene::environments
    EnvironmentLayout layout = EnvironmentLayout::equal_area;
    const RgbColorSpace* color_space = &RgbColorSpace::srgb();
    float scale = 1;
    Transform world_from_light;
};

using Light =
    std::variant<AreaLight, PointLight, SpotLight, DistantLight, UniformInfiniteLight, ImageInfiniteLight>;

} // namespace montelux
