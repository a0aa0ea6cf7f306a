// BilinearPatch: the surface spanned by four corners, and the rays that hit it.
#pragma once

#include <array>
#include <optional>

#include "montelux/mc/math/vec.h"

namespace montelux {

// The points p(u, v) for u and v in [0, 1]: between the corners p(0, 0), p(1, 0), p(0, 1) and p(1, 1), linear in
// u and in v. Its bounds are those of its corners.
struct BilinearPatch {
    Vec3d p00, p10, p01, p11;
};

// A value that is bilinear in u and v, by its values at the corners.
template <typename V, typename T>
V bilinear(const V& v00, const V& v10, const V& v01, const V& v11, T u, T v) {
    return (1 - v) * ((1 - u) * v00 + u * v10) + v * ((1 - u) * v01 + u * v11);
}

Vec3d point_of(const BilinearPatch& patch, double u, double v);
Vec3d dpdu_of(const BilinearPatch& patch, double v);
Vec3d dpdv_of(const BilinearPatch& patch, double u);
// dp/du x dp/dv: its length is the area per du dv. Bilinear between its values at the corners, as dp/du depends
// only on v and dp/dv on u.
Vec3d normal_of(const BilinearPatch& patch, double u, double v);

// By Gauss-Legendre quadrature of |normal_of|; exact for flat patches.
double area_of(const BilinearPatch& patch);

struct PatchHit {
    double t, u, v;
};
// The first hit of the ray o + t d with t in (t_min, t_max) (Reshetov 2019, "Cool Patches: A Geometric Approach
// to Ray/Bilinear Patch Intersections", Ray Tracing Gems ch. 8). Patches that share an edge leave no gap.
std::optional<PatchHit> intersect(const BilinearPatch& patch, Vec3d o, Vec3d d, double t_min, double t_max);

// A position whose density per area is nearly constant; exactly on parallelograms. `pdf` is per area; zero where
// the patch is degenerate.
struct PatchSample {
    double u, v, pdf;
};
PatchSample sample_area(const BilinearPatch& patch, Vec2d random);
// Density of sample_area there.
double area_pdf(const BilinearPatch& patch, double u, double v);

} // namespace montelux
