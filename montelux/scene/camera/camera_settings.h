// Cameras as plain values. Camera space: x right, y up, z forward; units of the scene.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/camera/aperture_picture.h"
#include "montelux/scene/index.h"
#include "montelux/scene/shape/motion.h"

namespace montelux {

// The screen window is the part of the z = 1 plane (perspective) or of the film plane (orthographic) that the
// full resolution covers; without one it is [-1, 1] (orthographic: times `scale`) on the shorter axis. A lens of
// radius 0 is a pinhole.
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
    float scale = 1; // of the window
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

// A spherical surface of a lens around the axis, or a stop (radius 0). Lengths in metres.
struct LensSurface {
    float radius = 0;          // of curvature; positive if the centre is on the film's side
    float thickness = 0;       // distance to the next surface towards the film
    float eta = 1;             // index of refraction of that space; 0 means air
    float aperture_radius = 0; // of the surface's edge
};
// A lens as it is built; camera space is in metres, the film in its plane z = 0. Pixels show irradiance: with a white
// scene of radiance 1, the solid angle of the exit pupil times its mean cosine.
struct RealisticCamera {
    std::vector<LensSurface> surfaces;         // from the scene to the film
    float focus_distance = 10;                 // from the film, metres
    float film_diagonal = 0.035f;              // metres
    std::optional<AperturePicture> aperture{}; // of the stops, which are round without it
};

using CameraModel = std::variant<PerspectiveCamera, OrthographicCamera, SphericalCamera, RealisticCamera>;

struct CameraSettings {
    CameraModel model = PerspectiveCamera{};
    Transform world_from_camera;    // of a moving camera: at time 0
    std::optional<Motion> motion{}; // of the camera itself
    // When the shutter opens and closes, in the time of motions; before 0 and after 1 everything stands still.
    float shutter_open = 0, shutter_close = 1;
    Index medium = no_index; // around the camera, into Scene::media; no_index: vacuum
};

} // namespace montelux
