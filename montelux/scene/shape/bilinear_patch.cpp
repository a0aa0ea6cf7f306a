#include "montelux/scene/shape/bilinear_patch.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/quadrature.h"
#include "montelux/mc/warp/linear.h"

namespace montelux {

namespace {

// Edges are widened by this part of the patch, far more than the rounding errors of u and v.
constexpr double edge_tolerance = 1e-10;

bool is_inside(double x) { return x >= -edge_tolerance && x <= 1 + edge_tolerance; }

// Lengths of normal_of at the corners.
std::array<double, 4> corner_densities(const BilinearPatch& p) {
    return {length(normal_of(p, 0, 0)), length(normal_of(p, 1, 0)), length(normal_of(p, 0, 1)),
            length(normal_of(p, 1, 1))};
}

bool has_area(const std::array<double, 4>& densities) {
    return densities[0] + densities[1] + densities[2] + densities[3] > 0;
}

} // namespace

Vec3d point_of(const BilinearPatch& p, double u, double v) {
    return bilinear(p.p00, p.p10, p.p01, p.p11, u, v);
}

Vec3d dpdu_of(const BilinearPatch& p, double v) { return (1 - v) * (p.p10 - p.p00) + v * (p.p11 - p.p01); }

Vec3d dpdv_of(const BilinearPatch& p, double u) { return (1 - u) * (p.p01 - p.p00) + u * (p.p11 - p.p10); }

Vec3d normal_of(const BilinearPatch& p, double u, double v) { return cross(dpdu_of(p, v), dpdv_of(p, u)); }

double area_of(const BilinearPatch& patch) {
    static const std::vector<QuadratureNode> rule = gauss_legendre_rule(8);
    double area = 0;
    for (const QuadratureNode& a : rule)
        for (const QuadratureNode& b : rule) area += a.weight * b.weight * length(normal_of(patch, a.x, b.x));
    return area;
}

std::optional<PatchHit> intersect(const BilinearPatch& patch, Vec3d o, Vec3d d, double t_min, double t_max) {
    // At u the patch is the segment a + v b, relative to o. The ray meets its line where d, a and b lie in a
    // plane: a quadratic equation of u.
    const Vec3d a0 = patch.p00 - o, a1 = patch.p10 - patch.p00;
    const Vec3d b0 = patch.p01 - patch.p00, b1 = (patch.p11 - patch.p10) - b0;
    const Vec3d d_a0 = cross(d, a0), d_a1 = cross(d, a1);
    const double c0 = dot(d_a0, b0), c1 = dot(d_a1, b0) + dot(d_a0, b1), c2 = dot(d_a1, b1);
    const double discriminant = c1 * c1 - 4 * c0 * c2;
    if (!(discriminant >= 0)) return std::nullopt;
    const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
    std::optional<PatchHit> nearest;
    for (double u : {c0 / q, q / c2}) {
        if (!is_inside(u)) continue; // nor if it is no number
        u = std::clamp(u, 0.0, 1.0);
        const Vec3d a = a0 + u * a1, b = b0 + u * b1, n = cross(d, b);
        const double n2 = length_squared(n);
        const double v = dot(cross(a, d), n) / n2, t = dot(cross(a, b), n) / n2;
        if (!is_inside(v) || !(t > t_min && t < t_max) || (nearest && nearest->t <= t)) continue;
        nearest = PatchHit{t, u, std::clamp(v, 0.0, 1.0)};
    }
    return nearest;
}

PatchSample sample_area(const BilinearPatch& patch, Vec2d random) {
    // Bilinear interpolation bounds |normal_of| from above, so that no density is too low.
    const std::array<double, 4> densities = corner_densities(patch);
    if (!has_area(densities)) return {0, 0, 0};
    const Vec2d p = sample_bilinear(random, densities);
    return {p.x, p.y, area_pdf(patch, p.x, p.y)};
}

double area_pdf(const BilinearPatch& patch, double u, double v) {
    const std::array<double, 4> densities = corner_densities(patch);
    const double area = length(normal_of(patch, u, v));
    return has_area(densities) && area > 0 ? bilinear_pdf({u, v}, densities) / area : 0;
}

} // namespace montelux
