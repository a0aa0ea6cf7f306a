// Alpha cut-outs: whether a hit is on the surface or in a hole.
#pragma once

#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"

namespace montelux {

// A point of alpha a is present with probability a. The decision is a function of the ray and the primitive
// only, so a sample remains a pure function of its key.
bool is_opaque(const SceneView& scene, const Ray& ray, const Hit& hit);

} // namespace montelux
