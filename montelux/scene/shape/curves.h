// Curves: thin surfaces along cubic curves, such as hair, fur and grass.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/shape/curve_segment.h"

namespace montelux {

// Each segment is a primitive. Positions are in world space, or in the space of the object definition.
struct Curves {
    enum class Kind : std::uint8_t {
        flat,     // faces each ray
        cylinder, // the same, with the normals of a cylinder
        ribbon,   // faces the normals of its segments
        tube, // faces each ray, with the normals and coordinates of a tube: u around it and v along all segments
    };
    Kind kind = Kind::flat;
    std::vector<std::array<Point3f, 4>> control_points; // of each segment's cubic Bezier curve
    std::vector<std::array<float, 2>> widths;           // of each segment at its ends
    std::vector<std::array<Normal3f, 2>> normals;       // the same, of unit length; empty unless a ribbon

    std::size_t segment_count() const { return control_points.size(); }
    CurveSegment segment(std::size_t i) const;
};

// A row of segments as readers give it.
struct Strand {
    std::span<const Point3f> points; // control points, see bezier_segments
    CurveBasis basis = CurveBasis::bezier;
    int degree = 3;
    float width0 = 1, width1 = 1;      // at its ends, linear between
    std::span<const Normal3f> normals; // of a ribbon, of any length: at the ends of all segments
};

// Appends a strand. Where the transformation stretches, widths grow by the cube root of its determinant. Throws
// Error for a wrong number of points or normals and for normals that are zero.
void append(Curves& curves, const Strand& strand, const Transform& world_from_object);

} // namespace montelux
