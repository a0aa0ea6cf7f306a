// Alpha cut-outs: whether a surface is there at a hit.
#pragma once

#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"

namespace montelux {

// A point with alpha a is there with probability a. The decision is a function of the ray and the primitive
// alone, so that a sample stays a pure function of its key.
bool is_opaque(const SceneView& scene, const Ray& ray, const Hit& hit);

} // namespace montelux
