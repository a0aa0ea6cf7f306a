// Embree's callbacks for quadrics, curves, bilinear patches and alpha cut-outs, one ray at a time or in packets.
#pragma once

#include <optional>

#include "montelux/accel/curve_pieces.h"
#include "montelux/accel/embree.h"
#include "montelux/scene/shape/quadric.h"
#include "montelux/scene/view.h"

namespace montelux {

// User data of the callbacks for one geometry.
struct GeometryData {
    const SceneView* scene = nullptr;
    Index shape = no_index;
    const Quadric* quadric = nullptr;      // null for other geometry
    std::optional<WorldSphere> sphere;     // if the quadric is one
    const Curves* curves = nullptr;        // null for other geometry
    CurvePieces pieces;                    // of the curves: Embree's primitives
    const BilinearMesh* patches = nullptr; // null for other geometry
    bool cut_out = false;
};

// For all geometry but meshes.
void fill_bounds(const RTCBoundsFunctionArguments* args);
void intersect_primitive(const RTCIntersectFunctionNArguments* args);
void occlude_primitive(const RTCOccludedFunctionNArguments* args);
// Rejects hits on the holes of meshes.
void filter_triangle(const RTCFilterFunctionNArguments* args);

} // namespace montelux
