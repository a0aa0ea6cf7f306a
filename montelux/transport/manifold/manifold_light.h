// add_manifold_light: light that reaches a vertex by way of one specular vertex, by specular manifold sampling.
#pragma once

#include "montelux/scene/camera/camera.h"
#include "montelux/transport/manifold/casters.h"
#include "montelux/transport/path_state.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

// The state's ray hit a surface, which is not shaded yet. If it is not specular, adds an unbiased estimate of the light
// of one covered lamp that one caster sends there: a seed on the caster leads to a solution, and the mean number of
// further seeds until one leads to the same is the inverse of the probability of finding it (Zeltner, Georgiev,
// Jakob 2020, section 4). Not in scenes with media. `footprint_scale` as of PathIntegrator. Sets scatters_narrowly in the
// state: lobes narrower than a lamp reflect few of its points, and scattering finds them.
void add_manifold_light(const Casters& casters, const SceneView& scene, RayTracer& tracer, PathState& state,
                        const Hit& hit, const Camera& camera, float footprint_scale, PhiloxStream stream);

} // namespace montelux
