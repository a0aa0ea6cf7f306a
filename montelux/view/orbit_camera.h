// The camera of a viewer that looks at a scene from elsewhere.
#pragma once

#include "montelux/render/renderer.h"
#include "montelux/scene/camera/camera_settings.h"
#include "montelux/view/viewed_render.h"

namespace montelux {

// What the camera of a render looks at: the surface in the middle of its picture, or else the middle of the scene's
// depth there.
Vec3d orbit_pivot(const Renderer& renderer);

// `camera` after an orbit about a point: by the azimuth to its own right about the axis of the world that is nearest to
// its upward direction, by the elevation upwards; its motion turns with it.
CameraSettings orbited(const CameraSettings& camera, Vec3d pivot, const ViewOrbit& orbit);

} // namespace montelux
