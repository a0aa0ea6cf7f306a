// LightEnd: the vertex of a path on a light, and the densities of finding it.
#pragma once

#include <cmath>

#include "montelux/scene/light/light_model.h"
#include "montelux/scene/view.h"

namespace montelux {

// Where a path begins at a light: v_0 of PathDensities.
struct LightEnd {
    Index light = no_index;
    LightKind kind = LightKind::surface;
    bool invisible = false; // no ray of the camera hits it
    LightHit hit;           // from the next vertex; of kind position the point alone
    float emission = 0;     // PathDensities::from_light[0]
    float edge = 0;         // density of the emission's other part, for from_light[1]: see edge_density

    bool at_infinity() const { return kind == LightKind::infinite || kind == LightKind::direction; }
    bool is_delta() const { return kind == LightKind::position || kind == LightKind::direction; }
    // from_light[1] at a point over that squared distance; `cosine`: between the light and the point's surface, 1 in media.
    float edge_density(float cosine, float distance2) const {
        const float density = edge * cosine;
        return at_infinity() ? density : density / distance2;
    }
    // A density per solid angle of the direction to the light (-w) as one per area of the light.
    float of_light(float pdf, Vec3f w, float distance2) const {
        if (kind != LightKind::surface) return pdf;
        return pdf * std::abs(dot(hit.n, w)) / distance2;
    }
};

// Density of next-event estimation finding the end from a point, to which its light comes along w.
float next_event_density(const SceneView& scene, float time, LightEnd& end, const ReferencePoint& from,
                         Vec3f w, float distance2);
// A light that the camera's side found; `w`: from it to the next vertex.
LightEnd end_at(const SceneView& scene, float time, Index light, const LightHit& hit, Vec3f w);

} // namespace montelux
