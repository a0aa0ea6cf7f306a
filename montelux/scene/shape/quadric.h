// Spheres, discs and cylinders: intersection in double precision, area, and points by surface coordinates.
#pragma once

#include <optional>

#include "montelux/scene/shape/bounds.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/scene/shape/shape.h"

namespace montelux {

struct QuadricPoint {
    Vec3d p, n;       // n: unit outward normal (sphere, cylinder), +z (disc); both in world space
    Point2f uv;       // as in pbrt-v4's file format, but for Disk::polar; only on request
    Vec3d dpdu, dpdv; // only on request; dpdu is replaced by a nonzero vector at poles and disc centres
};

Bounds3 world_bounds(const Quadric& quadric);
// The unit normal of flat quadrics, in world space.
std::optional<Vec3d> constant_normal(const Quadric& quadric);
// World-space area; by quadrature if the transform scales axes differently.
double world_area(const Quadric& quadric);

// The first hit with t in (t_min, ray.t_max); the ray is in world space.
std::optional<double> intersect(const Quadric& quadric, const Ray& ray, double t_min);

// Geometry at the point where `ray` hits at t: the point is projected onto the surface.
QuadricPoint point_at(const Quadric& quadric, const Ray& ray, double t, bool coordinates);

// A point uniform over the object-space area, and its density per world-space area.
struct QuadricAreaSample {
    QuadricPoint point;
    double pdf;
};
QuadricAreaSample sample_area(const Quadric& quadric, Vec2f u);
// Density of sample_area at a point with object-space normal direction mapped from world (1/area of world).
double area_pdf(const Quadric& quadric, Vec3d world_point);

// A whole sphere under a similarity transform: centre and radius in world space; otherwise empty.
struct WorldSphere {
    Vec3d center;
    double radius;
};
std::optional<WorldSphere> whole_sphere(const Quadric& quadric);
// As for Quadric.
std::optional<double> intersect(const WorldSphere& sphere, const Ray& ray, double t_min);

// A whole disc under any transform: an ellipse in world space, the points center + x s + y t with x^2 + y^2
// <= 1.
struct WorldDisk {
    Vec3f center, s, t;
    Normal3f n; // on the disc's +z side
    float area = 0;
};
std::optional<WorldDisk> whole_disk(const Quadric& quadric);

} // namespace montelux
