// CurvePieces: the parts of curves that have a box of their own in Embree's hierarchy.
#pragma once

#include "montelux/scene/shape/curves.h"

namespace montelux {

// Long segments that bend or run diagonally fill little of their box. Each segment has 2^levels pieces.
struct CurvePieces {
    unsigned levels = 0;

    std::size_t segment(std::size_t piece) const { return piece >> levels; }
    CurveRange range(std::size_t piece) const {
        const double length = 1.0 / static_cast<double>(1u << levels);
        const double u0 = static_cast<double>(piece & ((1u << levels) - 1)) * length;
        return {u0, u0 + length};
    }
};

// As many pieces as make the boxes much smaller, up to 8 a segment and 2^31 in all.
CurvePieces curve_pieces(const Curves& curves);

} // namespace montelux
