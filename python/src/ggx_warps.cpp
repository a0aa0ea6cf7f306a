#include "python/src/warp.h"
#include <array>
#include <cmath>
#include <string>
#include <variant>

#include "montelux/mc/dist/family/ggx_angle.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/bsdf/ggx.h"

namespace montelux::python {
namespace {

// One roughness for both axes, or one for each.
using Alpha = std::variant<double, std::array<double, 2>>;

Vec2d alpha_of(const Alpha& given, const char* where) {
    Vec2d a;
    if (const double* one = std::get_if<double>(&given))
        a = {*one, *one};
    else
        a = two(std::get<1>(given).data());
    for (const double v : {a.x, a.y})
        if (!(v >= double(Ggx::smooth_limit) && v <= 1e3))
            throw Error(where, "alpha " + std::to_string(v) +
                                   " was given; expected numbers from 0.001 (what is "
                                   "smoother is a mirror) to 1000");
    return a;
}

double turns_of(double x, double y) {
    const double turns = std::atan2(y, x) / (2 * pi);
    return turns < 0 ? turns + 1 : turns;
}

Warp ggx_normals(const Alpha& alpha) {
    const Vec2d a = alpha_of(alpha, "warp ggx_normals");
    const Ggx ggx{static_cast<float>(a.x), static_cast<float>(a.y)};
    // For roughness 1; others are stretched from it.
    const GgxAngleDistribution angle(1);
    return of_space(
        "ggx_normals",
        [=](Vec2d u) {
            const double theta = angle.sample(u.x), phi = 2 * pi * u.y, s = std::sin(theta);
            return normalize(Vec3d{a.x * s * std::cos(phi), a.y * s * std::sin(phi), std::cos(theta)});
        },
        [=](Vec3d m) { return m.z > 0 ? static_cast<double>(ggx.d(Vec3f(m))) * m.z : 0; },
        [=](Vec3d m) {
            const double x = m.x / a.x, y = m.y / a.y;
            return Vec2d{angle.cdf(std::atan2(std::hypot(x, y), m.z)), turns_of(x, y)};
        });
}

Warp ggx_visible_normals(const Alpha& alpha, std::array<double, 3> direction) {
    const Vec2d a = alpha_of(alpha, "warp ggx_visible_normals");
    const Ggx ggx{static_cast<float>(a.x), static_cast<float>(a.y)};
    const Vec3d given = three(direction.data());
    if (!(given.z > 0 && std::isfinite(length_squared(given))))
        throw Error("warp ggx_visible_normals", "expected a direction wo above the surface, wo[2] > 0");
    const Vec3d wo = normalize(given);
    // The view in the stretched space where the roughness is 1.
    const Vec3d view = normalize(Vec3d{wo.x * a.x, wo.y * a.y, wo.z});
    return of_space(
        "ggx_visible_normals", [=](Vec2d u) { return Vec3d(ggx.sample_visible(Vec3f(wo), Vec2f(u))); },
        [=](Vec3d m) {
            return m.z > 0 && dot(m, wo) > 0 ? static_cast<double>(ggx.visible_pdf(Vec3f(wo), Vec3f(m))) : 0;
        },
        [=](Vec3d m) {
            // A normal there is the half vector of the view and a direction uniform on a cap.
            const Vec3d h = normalize(Vec3d{m.x / a.x, m.y / a.y, m.z});
            const Vec3d on_cap = 2 * dot(h, view) * h - view;
            return Vec2d{turns_of(on_cap.x, on_cap.y), (1 - on_cap.z) / (1 + view.z)};
        });
}

} // namespace

void bind_ggx_warps(nb::module_& m) {
    m.def("warp_ggx_normals", &ggx_normals, "alpha"_a,
          "Microfacet normals of the GGX distribution: density D(m) cos(theta) per steradian.\n\n"
          "alpha: roughness, or (alpha_x, alpha_y). The surface's normal is +z.");
    m.def("warp_ggx_visible_normals", &ggx_visible_normals, "alpha"_a, "wo"_a,
          "Microfacet normals as they are seen from wo: density G1(wo) max(0, wo.m) D(m) / cos(wo) per "
          "steradian (Heitz 2014; Dupuy and Benyoub 2023).\n\n"
          "The renderer's own sampling, in single precision. wo: shape (3,), above the surface.");
}

} // namespace montelux::python
