#include "montelux/scene/shape/curves.h"

#include <cmath>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux {

CurveSegment Curves::segment(std::size_t i) const {
    CurveSegment s;
    for (std::size_t k = 0; k < 4; ++k) s.curve[k] = Vec3d(control_points[i][k]);
    s.width0 = static_cast<double>(widths[i][0]);
    s.width1 = static_cast<double>(widths[i][1]);
    if (!normals.empty()) s.normals = {Vec3d(normals[i][0]), Vec3d(normals[i][1])};
    return s;
}

void append(Curves& curves, const Strand& strand, const Transform& world_from_object) {
    const std::vector<CubicBezier> segments = bezier_segments(strand.points, strand.basis, strand.degree);
    const std::size_t count = segments.size();
    const std::size_t expected = curves.kind == Curves::Kind::ribbon ? count + 1 : 0;
    if (strand.normals.size() != expected)
        throw Error(std::to_string(strand.normals.size()) + " normals were given for " +
                    std::to_string(count) + (count == 1 ? " segment" : " segments") + "; expected " +
                    std::to_string(expected));
    const double scale = std::cbrt(std::abs(world_from_object.matrix().linear_determinant()));
    const auto width_at = [&](std::size_t end) {
        const double u = static_cast<double>(end) / static_cast<double>(count);
        return static_cast<float>(scale * ((1 - u) * double(strand.width0) + u * double(strand.width1)));
    };
    for (std::size_t i = 0; i < count; ++i) {
        auto& points = curves.control_points.emplace_back();
        for (std::size_t k = 0; k < 4; ++k) points[k] = Vec3f(world_from_object.point(segments[i][k]));
        curves.widths.push_back({width_at(i), width_at(i + 1)});
        if (expected == 0) continue;
        auto& normals = curves.normals.emplace_back();
        for (std::size_t k = 0; k < 2; ++k) {
            const Vec3d n = world_from_object.normal(Vec3d(strand.normals[i + k]));
            if (!(length_squared(n) > 0)) throw Error("a normal is zero");
            normals[k] = Vec3f(normalize(n));
        }
    }
}

} // namespace montelux
