// The values of cameras.
#pragma once

#include "montelux/scene/camera/camera_settings.h"
#include "montelux/scene/digest/hash_geometry.h"
#include "montelux/scene/digest/scene_hasher.h"

namespace montelux {

inline void hash_values(SceneHasher& h, const ScreenWindow& w) {
    const auto& [x_min, x_max, y_min, y_max] = w;
    h.all(x_min, x_max, y_min, y_max);
}
inline void hash_values(SceneHasher& h, const PerspectiveCamera& c) {
    const auto& [fov, lens_radius, focal_distance, frame_aspect_ratio, screen_window] = c;
    h.all(fov, lens_radius, focal_distance, frame_aspect_ratio, screen_window);
}
inline void hash_values(SceneHasher& h, const OrthographicCamera& c) {
    const auto& [scale, lens_radius, focal_distance, frame_aspect_ratio, screen_window] = c;
    h.all(scale, lens_radius, focal_distance, frame_aspect_ratio, screen_window);
}
inline void hash_values(SceneHasher& h, const SphericalCamera& c) {
    const auto& [mapping] = c;
    h.all(mapping);
}
inline void hash_values(SceneHasher& h, const LensSurface& s) {
    const auto& [radius, thickness, eta, aperture_radius] = s;
    h.all(radius, thickness, eta, aperture_radius);
}
inline void hash_values(SceneHasher& h, const RealisticCamera& c) {
    const auto& [surfaces, focus_distance, film_diagonal, aperture] = c;
    h.all(surfaces, focus_distance, film_diagonal);
    if (aperture) h.all(aperture->width, aperture->height, aperture->values);
}
inline void hash_values(SceneHasher& h, const CameraSettings& c) {
    const auto& [model, world_from_camera, motion, shutter_open, shutter_close, medium] = c;
    static_cast<void>(medium); // add_media
    h.all(model, world_from_camera, motion, shutter_open, shutter_close);
}

} // namespace montelux
