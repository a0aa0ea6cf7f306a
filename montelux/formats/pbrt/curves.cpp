#include "montelux/formats/pbrt/curves.h"

#include <string_view>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux::pbrt {
namespace {

Curves::Kind read_kind(ParameterReader& r) {
    const std::string_view name = r.choice("type", {"flat", "cylinder", "ribbon"}, "flat");
    return name == "ribbon" ? Curves::Kind::ribbon
                            : (name == "cylinder" ? Curves::Kind::cylinder : Curves::Kind::flat);
}

} // namespace

Curves read_curves(ParameterReader& r, const Transform& world_from_object) {
    Curves curves;
    curves.kind = read_kind(r);
    Strand strand;
    if (r.choice("basis", {"bezier", "bspline"}, "bezier") == "bspline") strand.basis = CurveBasis::bspline;
    strand.degree = r.integer("degree", 3);
    if (strand.degree != 2 && strand.degree != 3) r.error("degree", "parameter 'degree' must be 2 or 3");
    const std::vector<Point3f> points = r.triples("P", ParameterType::point3);
    if (points.empty()) r.error("shape 'curve' needs control points 'P'");
    strand.points = points;
    const float width = r.number("width", 1);
    strand.width0 = r.number("width0", width);
    strand.width1 = r.number("width1", width);
    if (!(strand.width0 >= 0 && strand.width1 >= 0)) r.error("the width of a curve is negative");
    const std::vector<Normal3f> normals = r.triples("N", ParameterType::normal);
    if (curves.kind == Curves::Kind::ribbon)
        strand.normals = normals;
    else if (!normals.empty())
        r.diagnostics().warn(r.at("N"),
                             "parameter 'N' matters to curves of type 'ribbon' only; it is ignored");
    r.ignored("splitdepth"); // how curves are split follows from their boxes
    try {
        montelux::append(curves, strand, world_from_object);
    } catch (const Error& e) {
        r.error(e.what());
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
