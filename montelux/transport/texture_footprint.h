// The footprint of a pixel on a surface, for texture look-ups.
#pragma once

#include "montelux/scene/camera/camera.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

// `scale`: size of the footprint in pixels. The surface point has coordinates.
TextureContext texture_context(const Camera& camera, float scale, const SurfacePoint& surface);

} // namespace montelux
