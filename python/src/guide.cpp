#include "python/src/guide.h"

#include "python/src/bindings.h"
#include "python/src/numpy_bridge.h"
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux::python {
namespace {

constexpr std::array<const char*, facings> facing_names{"-x", "+x", "-y", "+y", "-z", "+z", "medium"};

Vec3f guide_vector(const nb::handle& given, const std::string& what) {
    const Numbers n = numbers_of(given, what);
    if (n.values.size() != 3) throw Error(what, "expected three numbers");
    const Vec3f v{static_cast<float>(n.values[0]), static_cast<float>(n.values[1]),
                  static_cast<float>(n.values[2])};
    if (!std::isfinite(v.x + v.y + v.z)) throw Error(what, "expected three finite numbers");
    return v;
}

// The region of a point on a surface, or in a medium (None); null where no path has been.
const GuidingRegion* guide_region(const Guide& guide, Point3f p, const nb::handle& normal,
                                  const std::string& what) {
    Facing facing = Facing::medium;
    if (!normal.is_none()) {
        const Vec3f n = guide_vector(normal, what + ", normal");
        if (!(length(n) > 0)) throw Error(what + ", normal", "expected a vector other than zero");
        facing = facing_of(n);
    }
    return guide.field->find(p, facing);
}
Point3f guide_point(const nb::handle& point, const std::string& what) {
    return Point3f{} + guide_vector(point, what + ", point");
}

DoubleArray guide_pdf(const Guide& guide, const nb::object& point, const nb::object& normal,
                      const nb::object& directions) {
    const Point3f p = guide_point(point, "Guide.pdf");
    const GuidingRegion* region = guide_region(guide, p, normal, "Guide.pdf");
    const Rows w(directions, 3, "Guide.pdf, directions");
    NewArray out = new_array(w.shape());
    for (std::size_t i = 0; i < w.count(); ++i) {
        const Vec3d d{w[i][0], w[i][1], w[i][2]};
        const double size = length(d);
        if (!(size > 0 && std::isfinite(size)))
            throw Error("Guide.pdf, directions", "expected directions that are neither zero nor infinite");
        out.data[i] = region != nullptr ? static_cast<double>(region->pdf(p, Vec3f(d / size))) : 0;
    }
    return out.array;
}

double guide_share(const Guide& guide, const nb::object& point, const nb::object& normal) {
    const GuidingRegion* region =
        guide_region(guide, guide_point(point, "Guide.share"), normal, "Guide.share");
    return region != nullptr ? static_cast<double>(region->share) : 0;
}

nb::tuple guide_cells(const Guide& guide) {
    const std::vector<GuidingField::Cell> all = guide.field->cells();
    const std::size_t shape[] = {all.size(), 2, 3};
    NewArray bounds = new_array(shape);
    std::vector<std::string> names;
    double* to = bounds.data;
    for (const GuidingField::Cell& cell : all) {
        names.emplace_back(facing_names[static_cast<std::size_t>(cell.facing)]);
        for (const Point3f& corner : {cell.low, cell.high})
            for (int axis = 0; axis < 3; ++axis) *to++ = static_cast<double>(corner[axis]);
    }
    return nb::make_tuple(names, bounds.array);
}

} // namespace

void bind_guide(nb::module_& m) {
    nb::class_<Guide>(
        m, "Guide",
        "The directions that light comes from, as a guided render has learned them: `Render.guide`. Regions "
        "of space share a density of directions, apart for the six sides that surfaces face and for points "
        "in media.")
        .def("pdf", &guide_pdf, "point"_a, "normal"_a.none(), "directions"_a,
             "The density per solid angle of directions, shape (..., 3), at a point of a surface with this "
             "normal, or in a medium (None); zeros where no path has been.")
        .def("share", &guide_share, "point"_a, "normal"_a.none(),
             "The share of the directions there that are drawn from the guide; the others are drawn from the "
             "material or the phase function.")
        .def_prop_ro(
            "regions", [](const Guide& g) { return g.field->regions(); }, "How many there are.")
        .def_prop_ro(
            "bytes", [](const Guide& g) { return g.field->bytes(); }, "Its memory.")
        .def("cells", &guide_cells,
             "The regions: the side of each that surfaces face, '-x', '+x' ... '+z' or 'medium', and their "
             "bounds, shape (regions, 2, 3), infinite where only the scene ends them.");
}

} // namespace montelux::python
