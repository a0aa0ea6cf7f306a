#include "python/src/warp.h"
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/vec.h"
#include "montelux/mc/warp/cone.h"
#include "montelux/mc/warp/cosine.h"
#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/equal_area_square.h"
#include "montelux/mc/warp/exponential.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/mc/warp/linear.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/mc/warp/spherical_rectangle.h"
#include "montelux/mc/warp/spherical_triangle.h"
#include "montelux/mc/warp/tent.h"
#include "montelux/mc/warp/triangle.h"

namespace montelux::python {
namespace {

using Three = std::array<double, 3>;

// Rows of `columns` numbers, (n,) for one; applies f row by row.
template <typename F>
DoubleArray by_rows(const Warp& w, const nb::object& given, const char* what, std::size_t columns,
                    std::size_t results, const F& f, bool uniform = false) {
    const std::string where = "warp " + w.name + ", " + what;
    const Numbers n = numbers_of(given, where);
    const bool flat = columns == 1;
    if (!flat && (n.shape.empty() || n.shape.back() != columns))
        throw Error(where, "expected an array of shape (n, " + std::to_string(columns) + ")");
    if (uniform) require_uniform(n.values, where);
    std::vector<std::size_t> shape = n.shape;
    if (!flat) shape.pop_back();
    if (results > 1) shape.push_back(results);
    NewArray out = new_array(shape);
    {
        nb::gil_scoped_release unlocked;
        for (std::size_t i = 0; i < n.values.size() / columns; ++i)
            f(n.values.data() + i * columns, out.data + i * results);
    }
    return out.array;
}

void bind_plane(nb::module_& m) {
    m.attr("warp_uniform_disk_polar") = of_plane(
        "uniform_disk_polar", sample_uniform_disk_polar<double>,
        [](Vec2d p) { return length_squared(p) <= 1 ? uniform_disk_pdf<double>() : 0; },
        invert_uniform_disk_polar<double>);
    m.attr("warp_uniform_disk_concentric") = of_plane(
        "uniform_disk_concentric", sample_uniform_disk_concentric<double>,
        [](Vec2d p) { return length_squared(p) <= 1 + 1e-15 ? uniform_disk_pdf<double>() : 0; },
        invert_uniform_disk_concentric<double>);
    auto in_triangle = [](Vec3d b) { return b.x >= 0 && b.y >= 0 && b.z >= 0 ? 2.0 : 0.0; };
    m.attr("warp_uniform_triangle") = of_space("uniform_triangle", sample_uniform_triangle<double>,
                                               in_triangle, invert_uniform_triangle<double>);
    m.attr("warp_uniform_triangle_low_distortion") =
        of_space("uniform_triangle_low_distortion", sample_uniform_triangle_low_distortion<double>,
                 in_triangle, invert_uniform_triangle_low_distortion<double>);
    m.def(
        "warp_bilinear",
        [](std::array<double, 4> f) {
            for (double v : f)
                if (!(v >= 0 && std::isfinite(v)))
                    throw Error("warp bilinear", "expected four finite values that are not negative");
            if (!(f[0] + f[1] + f[2] + f[3] > 0)) throw Error("warp bilinear", "expected a value above zero");
            return of_plane(
                "bilinear", [f](Vec2d u) { return sample_bilinear(u, f); },
                [f](Vec2d p) { return bilinear_pdf(p, f); }, [f](Vec2d p) { return invert_bilinear(p, f); });
        },
        "corners"_a,
        "Density on the unit square proportional to the bilinear interpolation of the values at the corners "
        "(0, 0), (1, 0), (0, 1), (1, 1).");
}

void bind_sphere(nb::module_& m) {
    m.attr("warp_uniform_sphere") = of_space(
        "uniform_sphere", sample_uniform_sphere<double>, [](Vec3d) { return uniform_sphere_pdf<double>(); },
        invert_uniform_sphere<double>);
    m.attr("warp_equal_area_sphere") = of_space(
        "equal_area_sphere", equal_area_square_to_sphere<double>,
        [](Vec3d) { return uniform_sphere_pdf<double>(); }, equal_area_sphere_to_square<double>);
    m.attr("warp_uniform_hemisphere") = of_space(
        "uniform_hemisphere", sample_uniform_hemisphere<double>,
        [](Vec3d w) { return w.z >= 0 ? uniform_hemisphere_pdf<double>() : 0; },
        invert_uniform_hemisphere<double>);
    m.attr("warp_cosine_hemisphere") = of_space(
        "cosine_hemisphere", sample_cosine_hemisphere<double>,
        [](Vec3d w) { return cosine_hemisphere_pdf(w.z); }, invert_cosine_hemisphere<double>);
    m.def(
        "warp_uniform_cone",
        [](double c) {
            if (!(c >= -1 && c < 1)) throw Error("warp uniform_cone", "expected a cosine in [-1, 1)");
            return of_space(
                "uniform_cone", [c](Vec2d u) { return sample_uniform_cone(u, c); },
                [c](Vec3d w) { return w.z >= c - 1e-15 ? uniform_cone_pdf(c) : 0; },
                [c](Vec3d w) { return invert_uniform_cone(w, c); });
        },
        "cos_theta_max"_a, "Directions within an angle of +z, uniform in solid angle.");
    m.def(
        "warp_spherical_triangle",
        [](Three a, Three b, Three c) {
            const auto t =
                SphericalTriangle::from_directions(three(a.data()), three(b.data()), three(c.data()));
            if (!t) throw Error("warp spherical_triangle", "the triangle spans no solid angle");
            return of_space(
                "spherical_triangle", [t](Vec2d u) { return t->sample(u); },
                [t](Vec3d) { return t->pdf<double>(); }, [t](Vec3d w) { return t->inverse(w); });
        },
        "a"_a, "b"_a, "c"_a,
        "Directions within the triangle of the directions to three points, uniform in solid angle (Arvo "
        "1995). "
        "The density is for directions within it.");
    m.def(
        "warp_spherical_rectangle",
        [](Three from, Three corner, Three x, Three y) {
            const auto r = SphericalRectangle::from_corner(three(from.data()), three(corner.data()),
                                                           three(x.data()), three(y.data()));
            if (!r) throw Error("warp spherical_rectangle", "the rectangle spans no solid angle");
            return of_space(
                "spherical_rectangle", [r](Vec2d u) { return r->sample(u); },
                [r](Vec3d) { return r->pdf<double>(); }, [r](Vec3d w) { return r->inverse(w); });
        },
        "origin"_a, "corner"_a, "edge_x"_a, "edge_y"_a,
        "Directions from `origin` to the rectangle corner + s edge_x + t edge_y, uniform in solid angle "
        "(Urena et "
        "al. 2013). The density is for directions within it.");
}

void bind_line(nb::module_& m) {
    m.attr("warp_cosine") =
        of_numbers("cosine", sample_cosine<double>, cosine_pdf<double>, invert_cosine<double>);
    m.attr("warp_quadratic") =
        of_numbers("quadratic", sample_quadratic<double>, quadratic_pdf<double>, invert_quadratic<double>);
    m.def(
        "warp_linear",
        [](double a, double b) {
            if (!(a >= 0 && b >= 0 && a + b > 0 && std::isfinite(a + b)))
                throw Error("warp linear", "expected two values that are not negative, and not both zero");
            return of_numbers(
                "linear", [a, b](double u) { return sample_linear(u, a, b); },
                [a, b](double x) { return linear_pdf(x, a, b); },
                [a, b](double x) { return invert_linear(x, a, b); });
        },
        "a"_a, "b"_a, "Density on [0, 1] proportional to (1 - x) a + x b.");
    m.def(
        "warp_tent",
        [](double r) {
            if (!(r > 0 && std::isfinite(r))) throw Error("warp tent", "expected a radius above zero");
            return of_numbers(
                "tent", [r](double u) { return sample_tent(u, r); }, [r](double x) { return tent_pdf(x, r); },
                [r](double x) { return invert_tent(x, r); });
        },
        "radius"_a, "Density (radius - |x|) / radius^2 on [-radius, radius].");
    m.def(
        "warp_exponential",
        [](double rate, double length) {
            if (!(rate > 0 && length > 0))
                throw Error("warp exponential", "expected a rate and a length above zero");
            if (std::isinf(length))
                return of_numbers(
                    "exponential", [rate](double u) { return sample_exponential(u, rate); },
                    [rate](double x) { return exponential_pdf(x, rate); },
                    [rate](double x) { return invert_exponential(x, rate); });
            return of_numbers(
                "exponential", [=](double u) { return sample_truncated_exponential(u, rate, length); },
                [=](double x) { return truncated_exponential_pdf(x, rate, length); },
                [=](double x) { return invert_truncated_exponential(x, rate, length); });
        },
        "rate"_a, "length"_a = std::numeric_limits<double>::infinity(),
        "Density proportional to exp(-rate x) on [0, length).");
}

} // namespace

void bind_warps(nb::module_& m) {
    nb::class_<Warp>(m, "Warp", "A map of uniform numbers to points of a density, and back.")
        .def_ro("name", &Warp::name, "Its name.")
        .def_ro("uniforms", &Warp::uniforms, "Uniform numbers that a point takes.")
        .def_ro("coordinates", &Warp::coordinates, "Coordinates of a point.")
        .def(
            "sample",
            [](const Warp& s, const nb::object& u) {
                return by_rows(s, u, "sample", s.uniforms, s.coordinates, s.sample, true);
            },
            "u"_a,
            "Points for uniform numbers u in [0, 1], shape (n, uniforms): shape (n, coordinates); (n,) where "
            "that is one.")
        .def(
            "pdf",
            [](const Warp& s, const nb::object& x) {
                return by_rows(s, x, "pdf", s.coordinates, 1,
                               [&](const double* from, double* to) { *to = s.pdf(from); });
            },
            "x"_a, "Density at points, shape (n,): per unit length, area or steradian.")
        .def(
            "inverse",
            [](const Warp& s, const nb::object& x) {
                return by_rows(s, x, "inverse", s.coordinates, s.uniforms, s.inverse);
            },
            "x"_a, "The uniform numbers that sample() maps to x, shape (n, uniforms).")
        .def("__repr__", [](const Warp& s) { return "<montelux.warp." + s.name + ">"; });
    bind_plane(m);
    bind_sphere(m);
    bind_line(m);
    bind_ggx_warps(m);
}

} // namespace montelux::python
