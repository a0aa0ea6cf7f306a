// Light: the variant of all lights, plain values, one file per kind. Spectra are scaled so that radiance is
// in the units of the film.
#pragma once

#include <type_traits>
#include <variant>

#include "montelux/scene/light/area_light.h"
#include "montelux/scene/light/distant_light.h"
#include "montelux/scene/light/goniometric_light.h"
#include "montelux/scene/light/image_infinite_light.h"
#include "montelux/scene/light/point_light.h"
#include "montelux/scene/light/projection_light.h"
#include "montelux/scene/light/sky_light.h"
#include "montelux/scene/light/spot_light.h"
#include "montelux/scene/light/sun_light.h"
#include "montelux/scene/light/uniform_infinite_light.h"

namespace montelux {

using Light = std::variant<AreaLight, PointLight, SpotLight, DistantLight, UniformInfiniteLight,
                           ImageInfiniteLight, SkyLight, SunLight, GoniometricLight, ProjectionLight>;
static_assert(std::is_trivially_copyable_v<Light>);

inline LightKind kind_of(const Light& light) {
    return std::visit([](const auto& l) { return l.kind; }, light);
}
inline std::string_view name_of(const Light& light) {
    return std::visit([](const auto& l) { return l.name; }, light);
}

} // namespace montelux
