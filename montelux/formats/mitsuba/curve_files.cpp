#include "montelux/formats/mitsuba/curve_files.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/number.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/float_range.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::mitsuba {
namespace {

struct ControlPoint {
    Vec3d p;
    double radius = 0;
};

std::string_view without_spaces(std::string_view text) {
    constexpr std::string_view spaces = " \t\r";
    const std::size_t begin = text.find_first_not_of(spaces);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(spaces) - begin + 1);
}

ControlPoint control_point(std::string_view line, const std::string& where) {
    std::array<double, 4> numbers{};
    const char *at = line.data(), *end = at + line.size();
    for (double& number : numbers) {
        while (at != end && (*at == ' ' || *at == '\t')) ++at;
        const NumberResult read = parse_number(at, end, number);
        if (read.status != NumberStatus::ok)
            throw Error(where, "the control point is " + in_quotes(line) + "; expected x y z radius");
        at = read.end;
    }
    if (!(numbers[3] >= 0)) throw Error(where, "the radius of a control point is negative");
    return {{numbers[0], numbers[1], numbers[2]}, numbers[3]};
}

Point3f single(Vec3d p, const std::string& where) {
    if (!fits_float(p)) throw Error(where, "a control point is beyond what single-precision numbers hold");
    return Vec3f(p);
}

// The radius of a uniform cubic B-spline where its first segment begins.
double spline_radius(const ControlPoint& a, const ControlPoint& b, const ControlPoint& c) {
    return (a.radius + 4 * b.radius + c.radius) / 6;
}

void add_spline(Curves& curves, std::span<const ControlPoint> points, const Transform& to_world,
                const std::string& where) {
    if (points.size() < 4)
        throw Error(where, "a B-spline curve of " + std::to_string(points.size()) +
                               " control points; expected at least 4");
    for (std::size_t i = 0; i + 4 <= points.size(); ++i) {
        std::array<Point3f, 4> p;
        for (std::size_t k = 0; k < 4; ++k) p[k] = single(to_world.point(points[i + k].p), where);
        append(curves,
               {.points = p,
                .basis = CurveBasis::bspline,
                .width0 = static_cast<float>(2 * spline_radius(points[i], points[i + 1], points[i + 2])),
                .width1 = static_cast<float>(2 * spline_radius(points[i + 1], points[i + 2], points[i + 3])),
                .normals = {}},
               {});
    }
}

void add_polyline(Curves& curves, std::span<const ControlPoint> points, const Transform& to_world,
                  const std::string& where) {
    if (points.size() < 2) throw Error(where, "a linear curve of 1 control point; expected at least 2");
    for (std::size_t i = 0; i + 2 <= points.size(); ++i) {
        const Vec3d a = to_world.point(points[i].p), b = to_world.point(points[i + 1].p);
        std::array<Point3f, 4> p;
        for (std::size_t k = 0; k < 4; ++k) p[k] = single(a + (static_cast<double>(k) / 3) * (b - a), where);
        append(curves,
               {.points = p,
                .width0 = static_cast<float>(2 * points[i].radius),
                .width1 = static_cast<float>(2 * points[i + 1].radius),
                .normals = {}},
               {});
    }
}

} // namespace

Curves read_curves(Plugin& shape, const Transform& to_world) {
    const std::filesystem::path path = shape.file("filename");
    const std::vector<std::uint8_t> bytes = shape.graph().files.read(path, shape.at());
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Curves curves;
    // Hair takes the offset across the fibre for v.
    const std::optional<Plugin> bsdf = shape.child("bsdf");
    curves.kind = bsdf && bsdf->type() == "hair" ? Curves::Kind::cylinder : Curves::Kind::tube;
    const auto add = shape.type() == "linearcurve" ? add_polyline : add_spline;
    std::vector<ControlPoint> points;
    std::size_t line_number = 0;
    try {
        const auto end_curve = [&] {
            const std::string where = path.string() + ":" + std::to_string(line_number);
            if (!points.empty()) add(curves, points, to_world, where);
            points.clear();
        };
        while (!text.empty()) {
            ++line_number;
            const std::size_t length = std::min(text.find('\n'), text.size());
            const std::string_view line = without_spaces(text.substr(0, length));
            text.remove_prefix(std::min(length + 1, text.size()));
            if (line.empty())
                end_curve();
            else
                points.push_back(control_point(line, path.string() + ":" + std::to_string(line_number)));
        }
        end_curve();
        if (curves.segment_count() == 0) throw Error(path.string(), "there are no control points");
    } catch (const LocatedError&) {
        throw;
    } catch (const Error& e) {
        shape.error(e.what());
    }
    return curves;
}

} // namespace montelux::mitsuba
