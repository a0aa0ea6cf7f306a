// Alpha: the probability that a point of a surface is present.
#pragma once

#include <optional>

#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"

namespace montelux {

// Whether some rays may pass through the shape.
bool is_cut_out(const Shape& shape);
// For a shape of constant alpha.
std::optional<float> constant_alpha(const SceneView& scene, const Shape& shape);

// At a hit of `ray`, in the space of the shape; not limited to [0, 1].
float alpha_at(const SceneView& scene, const Ray& ray, const Hit& hit);

} // namespace montelux
