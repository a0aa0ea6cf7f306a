// Alpha: the share of a surface's points that is there.
#pragma once

#include <optional>

#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"

namespace montelux {

// Whether a ray that meets the shape may go through it.
bool is_cut_out(const Shape& shape);
// Of a shape whose alpha is the same everywhere.
std::optional<float> constant_alpha(const SceneView& scene, const Shape& shape);

// At a hit of `ray`, which is in the space of the shape; not limited to [0, 1].
float alpha_at(const SceneView& scene, const Ray& ray, const Hit& hit);

} // namespace montelux
