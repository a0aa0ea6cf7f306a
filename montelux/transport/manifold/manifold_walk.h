// manifold_walk: from a seed on a caster to a point that sends the light of a lamp to a vertex, by Newton's method.
#pragma once

#include <optional>

#include "montelux/transport/manifold/casters.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

// The two ends of a path of one specular vertex: a vertex that scatters, and a point of a light.
struct ManifoldEnds {
    ReferencePoint from;
    Vec3d light;          // position, or the unit direction to a light at infinity
    bool distant = false; // at infinity
    float time = 0;       // of rays

    Vec3d vertex() const { return Vec3d(from.p); }
};

struct ManifoldSolution {
    CasterPoint point;
    bool reflects = false;
};

// The specular vertex that the walk from the seed leads to, whether or not anything occludes it; empty if the walk
// does not converge. A function of its arguments alone. Seeds between which and the light the tangent plane lies walk
// to a vertex that refracts, others, and those on mirrors, to one that reflects. Zeltner, Georgiev, Jakob 2020,
// "Specular Manifold Sampling for Rendering High-Frequency Caustics and Glints".
std::optional<ManifoldSolution> walk_manifold(const SceneView& scene, RayTracer& tracer, const Caster& caster,
                                              const ManifoldEnds& ends, const CasterPoint& seed);

// Whether two walks ended at the same vertex.
bool is_same(const ManifoldSolution& a, const ManifoldSolution& b, const ManifoldEnds& ends);

// Number of walks from random seeds until one ends at the solution again. Its mean is the inverse of the probability
// that a seed leads there (Booth 2007, "Unbiased Monte Carlo Estimation of the Reciprocal of an Integral"). NaN after
// most_manifold_trials, which makes the sample bad: it is left out and counted.
inline constexpr int most_manifold_trials = 1 << 20;
float inverse_probability(const SceneView& scene, RayTracer& tracer, const Caster& caster,
                          const ManifoldEnds& ends, const ManifoldSolution& solution, PhiloxStream& stream);

// Solid angle at the vertex per area across the ray at the light (per solid angle of a light at infinity): the
// generalised geometric term of Jakob and Marschner 2012, "Manifold Exploration". Infinite where the vertex is in focus.
double manifold_geometry(const ManifoldSolution& solution, const ManifoldEnds& ends, const Caster& caster);

} // namespace montelux
