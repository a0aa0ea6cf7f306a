#include "montelux/formats/pbrt/curves.h"

#include <cmath>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux::pbrt {
namespace {

Curves::Kind read_kind(ParameterReader& r) {
    const std::string_view name = r.choice("type", {"flat", "cylinder", "ribbon"}, "flat");
    return name == "ribbon" ? Curves::Kind::ribbon
                            : (name == "cylinder" ? Curves::Kind::cylinder : Curves::Kind::flat);
}

std::vector<CubicBezier> read_segments(ParameterReader& r) {
    const CurveBasis basis = r.choice("basis", {"bezier", "bspline"}, "bezier") == "bspline"
                                 ? CurveBasis::bspline
                                 : CurveBasis::bezier;
    const int degree = r.integer("degree", 3);
    if (degree != 2 && degree != 3) r.error("degree", "parameter 'degree' must be 2 or 3");
    const std::vector<Point3f> points = r.triples("P", ParameterType::point3);
    if (points.empty()) r.error("shape 'curve' needs control points 'P'");
    try {
        return bezier_segments(points, basis, degree);
    } catch (const Error& e) {
        r.error("P", e.what());
    }
}

std::vector<Vec3f> read_normals(ParameterReader& r, Curves::Kind kind, std::size_t segments) {
    std::vector<Vec3f> normals = r.triples("N", ParameterType::normal);
    if (kind != Curves::Kind::ribbon) {
        if (!normals.empty())
            r.diagnostics().warn(r.at("N"),
                                 "parameter 'N' matters to curves of type 'ribbon' only; it is ignored");
        return {};
    }
    if (normals.size() != segments + 1)
        r.error("N", "a ribbon of " + std::to_string(segments) + " segments needs " +
                         std::to_string(segments + 1) + " normals 'N'; " + std::to_string(normals.size()) +
                         " were given");
    return normals;
}

} // namespace

Curves read_curves(ParameterReader& r, const Transform& world_from_object) {
    Curves curves;
    curves.kind = read_kind(r);
    const std::vector<CubicBezier> segments = read_segments(r);
    const float width = r.number("width", 1);
    const float ends[2] = {r.number("width0", width), r.number("width1", width)};
    if (!(ends[0] >= 0 && ends[1] >= 0)) r.error("the width of a curve is negative");
    const std::vector<Vec3f> normals = read_normals(r, curves.kind, segments.size());
    r.ignored("splitdepth"); // how curves are split follows from their boxes

    const double scale = std::cbrt(std::abs(world_from_object.matrix().linear_determinant()));
    const auto width_at = [&](std::size_t end) {
        const double u = static_cast<double>(end) / static_cast<double>(segments.size());
        return static_cast<float>(scale * ((1 - u) * double(ends[0]) + u * double(ends[1])));
    };
    for (std::size_t i = 0; i < segments.size(); ++i) {
        auto& points = curves.control_points.emplace_back();
        for (std::size_t k = 0; k < 4; ++k) points[k] = Vec3f(world_from_object.point(segments[i][k]));
        curves.widths.push_back({width_at(i), width_at(i + 1)});
        if (normals.empty()) continue;
        auto& ends_normals = curves.normals.emplace_back();
        for (std::size_t k = 0; k < 2; ++k) {
            const Vec3f n = world_from_object.normal(normals[i + k]);
            if (!(length_squared(n) > 0)) r.error("N", "a normal is zero");
            ends_normals[k] = normalize(n);
        }
    }
    return curves;
}

void append(Curves& curves, const Curves& more) {
    const auto add = [](auto& values, const auto& others) {
        values.insert(values.end(), others.begin(), others.end());
    };
    add(curves.control_points, more.control_points);
    add(curves.widths, more.widths);
    add(curves.normals, more.normals);
}

} // namespace montelux::pbrt
