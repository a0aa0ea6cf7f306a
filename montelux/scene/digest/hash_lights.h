// The values of lights and of their skies.
#pragma once

#include "montelux/scene/digest/scene_hasher.h"
#include "montelux/scene/light/light.h"
#include "montelux/scene/light/sky/sky_model.h"

namespace montelux {

inline void hash_values(SceneHasher& h, const AreaLight& l) {
    const auto& [spectrum, scale, two_sided, shape, primitive_flux, picture] = l;
    h.all(spectrum, scale, two_sided, shape, primitive_flux);
    if (picture != no_index) h.all(picture);
}
inline void hash_values(SceneHasher& h, const PointLight& l) {
    const auto& [spectrum, scale, position] = l;
    h.all(spectrum, scale, position);
}
inline void hash_values(SceneHasher& h, const SpotLight& l) {
    const auto& [spectrum, scale, position, axis, cos_falloff_start, cos_total_width] = l;
    h.all(spectrum, scale, position, axis, cos_falloff_start, cos_total_width);
}
inline void hash_values(SceneHasher& h, const DistantLight& l) {
    const auto& [spectrum, scale, to_light] = l;
    h.all(spectrum, scale, to_light);
}
inline void hash_values(SceneHasher& h, const Portal& p) { h.all(p.corners()); }
inline void hash_values(SceneHasher& h, const UniformInfiniteLight& l) {
    const auto& [spectrum, scale, portal] = l;
    h.all(spectrum, scale, portal);
}
inline void hash_values(SceneHasher& h, const ImageInfiniteLight& l) {
    const auto& [environment, layout, scale, world_from_light, portal] = l;
    h.all(environment, layout, scale, world_from_light, portal);
}
inline void hash_values(SceneHasher& h, const SkyLight& l) {
    const auto& [sky, environment, scale, world_from_light] = l;
    h.all(sky, environment, scale, world_from_light);
}
inline void hash_values(SceneHasher& h, const SunDisc& d) {
    const auto& [centre, versine] = d;
    h.all(centre, versine);
}
inline void hash_values(SceneHasher& h, const SunLight& l) {
    const auto& [spectrum, scale, disc, up] = l;
    h.all(spectrum, scale, disc, up);
}
inline void hash_values(SceneHasher& h, const GoniometricLight& l) {
    const auto& [spectrum, scale, environment, layout, world_from_map] = l;
    h.all(spectrum, scale, environment, layout, world_from_map);
}
inline void hash_values(SceneHasher& h, const ProjectionLight& l) {
    const auto& [environment, scale, fov, world_from_light] = l;
    h.all(environment, scale, fov, world_from_light);
}
// Its tables follow from its settings.
inline void hash_values(SceneHasher& h, const SkyModel& sky) {
    const auto& [elevation, azimuth, atmosphere, ground_albedo] = sky.settings();
    const auto& [turbidity, angstrom_exponent, aerosol_albedo, aerosol_g, ozone] = atmosphere;
    h.all(elevation, azimuth, ground_albedo);
    h.all(turbidity, angstrom_exponent, aerosol_albedo, aerosol_g, ozone);
}

} // namespace montelux
