// Cameras as plain values. Camera space: x right, y up, z forward; units of the scene.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/index.h"
#include "montelux/scene/shape/motion.h"

namespace montelux {

// The screen window is the part of the z = 1 plane (perspective) or of the film plane (orthographic) that the
// full resolution covers; without one it is [-1, 1] on the shorter axis. A lens of radius 0 is a pinhole.
struct ScreenWindow {
    float x_min = -1, x_max = 1, y_min = -1, y_max = 1;
};
struct PerspectiveCamera {
    float fov = 90; // degrees, over the shorter axis
    float lens_radius = 0;
    float focal_distance = 1e6f;
    std::optional<float> frame_aspect_ratio{};
    std::optional<ScreenWindow> screen_window{};
};
struct OrthographicCamera {
    float lens_radius = 0;
    float focal_distance = 1e6f;
    std::optional<float> frame_aspect_ratio{};
    std::optional<ScreenWindow> screen_window{};
};
// Every direction: the film is an equal-area octahedral or a latitude-longitude map.
struct SphericalCamera {
    enum class Mapping : std::uint8_t { equal_area, equirectangular };
    Mapping mapping = Mapping::equal_area;
};

using CameraModel = std::variant<PerspectiveCamera, OrthographicCamera, SphericalCamera>;

struct CameraSettings {
    CameraModel model = PerspectiveCamera{};
    Transform world_from_camera;    // of a moving camera: at time 0
    std::optional<Motion> motion{}; // of the camera itself
    // When the shutter opens and closes, in the time of motions; before 0 and after 1 everything stands still.
    float shutter_open = 0, shutter_close = 1;
    Index medium = no_index; // around the camera, into Scene::media; no_index: vacuum
};

} // namespace montelux
