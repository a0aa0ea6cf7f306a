#include "montelux/accel/curve_pieces.h"

#include <algorithm>

namespace montelux {

namespace {

// Rays hit a box in proportion to its area.
double surface_area(const Bounds3& b) {
    const Vec3d d = b.upper - b.lower;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

// Of the boxes of evenly chosen segments.
double total_area(const Curves& curves, CurvePieces pieces) {
    constexpr std::size_t most_segments = 1000;
    const std::size_t stride = curves.segment_count() / most_segments + 1;
    double sum = 0;
    for (std::size_t i = 0; i < curves.segment_count(); i += stride) {
        const CurveSegment segment = curves.segment(i);
        for (std::size_t piece = 0; piece < std::size_t{1} << pieces.levels; ++piece)
            sum += surface_area(bounds_of(segment, pieces.range(piece)));
    }
    return sum;
}

} // namespace

CurvePieces curve_pieces(const Curves& curves) {
    constexpr unsigned most_levels = 3;
    constexpr double worthwhile = 0.8; // of the area before
    CurvePieces pieces;
    for (double area = total_area(curves, pieces); pieces.levels < most_levels; ++pieces.levels) {
        const double split = total_area(curves, {pieces.levels + 1});
        if (!(split < worthwhile * area) || curves.segment_count() >> (30 - pieces.levels) != 0) break;
        area = split;
    }
    return pieces;
}

} // namespace montelux
