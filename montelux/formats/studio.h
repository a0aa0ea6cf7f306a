// The studio: light, ground and camera for scenes whose files have none, and those that a user asks for instead.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/studio_settings.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"
#include "montelux/scene/shape/bounds.h"

namespace montelux {

// What a studio has added to a scene for want of it.
struct StudioParts {
    bool camera = false, lights = false;
    // "camera and no environment", as a sentence with "has no" says it; empty if nothing was added.
    std::string_view missing() const {
        if (camera) return lights ? "camera and no environment" : "camera";
        return lights ? "environment" : "";
    }
};

// Field of view of the studio's camera, over the shorter axis of the film.
inline constexpr double studio_fov = 30; // degrees

// Adds what the scene lacks, if it wants a studio, and what the settings ask for, of any scene. The film must have its
// final size. `files_read`, if given, receives the file of the environment map. Throws Error for a map that cannot be
// read, and where there is nothing to frame.
StudioParts add_studio(SceneDescription& description, const StudioSettings& settings, FileSource& files,
                       Warnings& warnings, std::vector<std::filesystem::path>* files_read = nullptr);

// The axes of an orbit, unit vectors: `right` is to the right of one who looks from the front at the scene.
struct OrbitFrame {
    Vec3d right, up, front;
    // `up` points along an axis. `mirrored`: the world is left-handed, as that of pbrt's scenes is.
    static OrbitFrame of(Vec3d up, bool mirrored = false);
};

// Distance from the centre of the bounds from which a camera of that field of view sees the upright cylinder around
// them, with a margin: it depends on the elevation (degrees), not on the azimuth. `aspect`: width over height of the
// film. Bounds of a point count as those of a cube of side 1.
double framing_distance(const Bounds3& bounds, const OrbitFrame& frame, double elevation, double fov,
                        double aspect);

// The camera of an orbit: it looks along the direction to the centre, and is shifted upright so that the cylinder has
// equal margins above and below where `distance` is 1.
CameraSettings framing_camera(const Bounds3& bounds, const OrbitFrame& frame, const Orbit& orbit, double fov,
                              double aspect);

// The upright axis through the middle of a scene; its direction is such that a camera that turns by a positive angle
// comes to a larger azimuth.
struct TurnAxis {
    Vec3d point, direction;
};
// Of a scene before add_studio, whose ground is no part of it. Errors: a scene without shapes.
TurnAxis turn_axis_of(const SceneDescription& description);
// The camera, and the path that it moves along, after a turn.
CameraSettings turned_camera(const CameraSettings& camera, const TurnAxis& axis, double degrees);

} // namespace montelux
