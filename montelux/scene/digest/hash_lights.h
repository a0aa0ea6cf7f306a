// The values of lights and of their skies.
#pragma once

#include <cstdint>

#include "montelux/scene/digest/scene_hasher.h"
#include "montelux/scene/light/light.h"
#include "montelux/scene/light/sky/sky_model.h"

namespace montelux {

inline void hash_values(SceneHasher& h, const AreaLight& l) {
    const auto& [spectrum, scale, two_sided, shape, primitive_flux, picture, picture_lookup, equal_energy] =
        l;
    h.all(spectrum, scale, two_sided, shape, primitive_flux);
    if (picture != no_index) h.all(picture, picture_lookup);
    if (equal_energy) h.all(equal_energy);
}
inline void hash_values(SceneHasher& h, const PointLight& l) {
    const auto& [spectrum, scale, position, motion] = l;
    h.all(spectrum, scale, position);
    if (motion != no_index) h.all(motion);
}
inline void hash_values(SceneHasher& h, const SpotLight& l) {
    const auto& [spectrum, scale, position, axis, cos_falloff_start, cos_total_width, motion, profile,
                 picture, picture_lookup, picture_x, picture_y] = l;
    h.all(spectrum, scale, position, axis, cos_falloff_start, cos_total_width);
    if (motion != no_index) h.all(motion);
    if (profile != SpotFalloff::smooth) h.all(profile);
    if (picture != no_index) h.all(picture, picture_lookup, picture_x, picture_y);
}
inline void hash_values(SceneHasher& h, const DistantLight& l) {
    const auto& [spectrum, scale, to_light, motion] = l;
    h.all(spectrum, scale, to_light);
    if (motion != no_index) h.all(motion);
}
inline void hash_values(SceneHasher& h, const Portal& p) { h.all(p.corners()); }
inline void hash_values(SceneHasher& h, const UniformInfiniteLight& l) {
    const auto& [spectrum, scale, portal] = l;
    h.all(spectrum, scale, portal);
}
inline void hash_values(SceneHasher& h, const ImageInfiniteLight& l) {
    const auto& [environment, layout, scale, world_from_light, portal, motion] = l;
    h.all(environment, layout, scale, world_from_light, portal);
    if (motion != no_index) h.all(motion);
}
inline void hash_values(SceneHasher& h, const SkyLight& l) {
    const auto& [sky, environment, scale, world_from_light, motion] = l;
    h.all(sky, environment, scale, world_from_light);
    if (motion != no_index) h.all(motion);
}
inline void hash_values(SceneHasher& h, const SunDisc& d) {
    const auto& [centre, versine] = d;
    h.all(centre, versine);
}
inline void hash_values(SceneHasher& h, const SunLight& l) {
    const auto& [spectrum, scale, disc, up, motion] = l;
    h.all(spectrum, scale, disc, up);
    if (motion != no_index) h.all(motion);
}
inline void hash_values(SceneHasher& h, const GoniometricLight& l) {
    const auto& [spectrum, scale, environment, layout, world_from_map, motion] = l;
    h.all(spectrum, scale, environment, layout, world_from_map);
    if (motion != no_index) h.all(motion);
}
inline void hash_values(SceneHasher& h, const ProjectionLight& l) {
    const auto& [environment, scale, fov, world_from_light, motion, profile, equal_energy, picture_lookup] =
        l;
    h.all(environment, scale, fov, world_from_light);
    if (motion != no_index) h.all(motion);
    // Numbered, as both are a byte.
    if (profile != ProjectionProfile::intensity) h.all(std::uint8_t{1}, profile, picture_lookup);
    if (equal_energy) h.all(std::uint8_t{2}, equal_energy);
}
// Its tables follow from its settings.
inline void hash_values(SceneHasher& h, const SkyModel& sky) {
    const auto& [elevation, azimuth, atmosphere, ground_albedo] = sky.settings();
    const auto& [turbidity, angstrom_exponent, aerosol_albedo, aerosol_g, ozone] = atmosphere;
    h.all(elevation, azimuth, ground_albedo);
    h.all(turbidity, angstrom_exponent, aerosol_albedo, aerosol_g, ozone);
}

} // namespace montelux
