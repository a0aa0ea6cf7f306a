// visible_pixel: how large a pixel is where the camera's path first scatters by no delta.
#pragma once

#include <optional>

#include "montelux/scene/camera/camera.h"
#include "montelux/transport/integrator_model.h"

namespace montelux {

// The side of a square pixel across the path, in units of the scene: seen through mirrors and smooth glass as at the
// same distance directly. Empty where the path meets no such surface.
template <RandomStream Stream>
std::optional<double> visible_pixel(const SceneView& scene, const Camera& camera, RayTracer& tracer,
                                    const CameraSample& sample, Stream& stream);

} // namespace montelux
