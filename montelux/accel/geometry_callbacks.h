// Embree's callbacks for quadrics and alpha cut-outs, one ray at a time or in packets.
#pragma once

#include <optional>

#include "montelux/accel/embree.h"
#include "montelux/scene/shape/quadric.h"
#include "montelux/scene/view.h"

namespace montelux {

// User data of the callbacks for one geometry.
struct GeometryData {
    const SceneView* scene = nullptr;
    Index shape = no_index;
    const Quadric* quadric = nullptr;  // null for meshes
    std::optional<WorldSphere> sphere; // if the quadric is one
    bool cut_out = false;
};

void fill_quadric_bounds(const RTCBoundsFunctionArguments* args);
void intersect_quadric(const RTCIntersectFunctionNArguments* args);
void occlude_quadric(const RTCOccludedFunctionNArguments* args);
// Rejects hits on the holes of meshes.
void filter_triangle(const RTCFilterFunctionNArguments* args);

} // namespace montelux
