#include "montelux/scene/shape/curves.h"

namespace montelux {

CurveSegment Curves::segment(std::size_t i) const {
    CurveSegment s;
    for (std::size_t k = 0; k < 4; ++k) s.curve[k] = Vec3d(control_points[i][k]);
    s.width0 = static_cast<double>(widths[i][0]);
    s.width1 = static_cast<double>(widths[i][1]);
    if (!normals.empty()) s.normals = {Vec3d(normals[i][0]), Vec3d(normals[i][1])};
    return s;
}

} // namespace montelux
