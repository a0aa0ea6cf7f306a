// Spheres and discs: intersection in double precision, area, and the point of a surface coordinate.
#pragma once

#include <optional>

#include "montelux/scene/shape/bounds.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/scene/shape/shape.h"

namespace montelux {

struct QuadricPoint {
    Vec3d p, n;       // n: unit outward normal (sphere), +z (disc); both in world space
    Point2f uv;       // u = phi / phi_max; v as in pbrt-v4's file format; only when asked for
    Vec3d dpdu, dpdv; // likewise; the first is never zero, though it should be at a pole or a disc's centre
};

Bounds3 world_bounds(const Quadric& quadric);
// The normal of flat quadrics, unit, in world space.
std::optional<Vec3d> constant_normal(const Quadric& quadric);
// World-space area, by quadrature where the transform scales axes differently.
double world_area(const Quadric& quadric);

// The first hit with t in (t_min, ray.t_max); the ray is in world space.
std::optional<double> intersect(const Quadric& quadric, const Ray& ray, double t_min);

// Geometry at the point where `ray` hits at t: the point is projected onto the surface.
QuadricPoint point_at(const Quadric& quadric, const Ray& ray, double t, bool coordinates);

// A point distributed uniformly over the area of object space, and its density per world-space area.
struct QuadricAreaSample {
    QuadricPoint point;
    double pdf;
};
QuadricAreaSample sample_area(const Quadric& quadric, Vec2f u);
// Density of sample_area at a point with object-space normal direction mapped from world (1/area of world).
double area_pdf(const Quadric& quadric, Vec3d world_point);

// A whole sphere under a similarity transform: centre and radius in world space; else empty.
struct WorldSphere {
    Vec3d center;
    double radius;
};
std::optional<WorldSphere> whole_sphere(const Quadric& quadric);
// As for the quadric.
std::optional<double> intersect(const WorldSphere& sphere, const Ray& ray, double t_min);

// A whole disc, whatever its transform: an ellipse in world space, the points center + x s + y t with x^2 +
// y^2 <= 1.
struct WorldDisk {
    Vec3f center, s, t;
    Normal3f n; // of the disc's +z side
    float area = 0;
};
std::optional<WorldDisk> whole_disk(const Quadric& quadric);

} // namespace montelux
