// tilted_frame: the frame of a shading normal tilted by bumps and a normal map.
#pragma once

#include <optional>

#include "montelux/scene/material/surface_detail.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/scene/view.h"

namespace montelux {

// Bumps are heights above the surface along its shading normal (Blinn 1978, "Simulation of Wrinkled
// Surfaces"); the map is applied in the frame of the surface with its bumps. `surface` must have texture
// coordinates. Empty if the normal is unchanged, to the last bit.
//
// The normal is on the side of the geometric one, and turned only as far as necessary for the mirror
// direction of wo to stay above the surface. Of a `shadowed` detail it is mirrored at the surface's shading normal where
// it would face away from wo.
std::optional<Frame> tilted_frame(const SceneView& scene, const SurfaceDetail& detail,
                                  const SurfacePoint& surface, Vec3f wo, const TextureContext& context);

} // namespace montelux
