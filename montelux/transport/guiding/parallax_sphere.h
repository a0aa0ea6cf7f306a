// ParallaxSphere: directions from any point of a region, as directions from its centre to a sphere around it.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Light from nearby comes from other directions at each point of a region: what they have in common is the place that it
// comes from. A direction from p stands for the point of the sphere that it leads to, and that point for its direction
// from the centre (after Ruppert et al. 2020, "Robust Fitting of Parallax-Aware Mixtures for Path Guiding", whose lobes
// have a distance each; with one sphere the map is one-to-one). Points near the sphere or outside have a larger one each.
struct ParallaxSphere {
    Point3f centre;
    float radius = 0; // 0: infinite; directions are the same everywhere

    // A direction after the map, and the solid angle from the centre over that from p.
    struct Mapped {
        Vec3f w;
        float density = 1;
    };
    Mapped from_centre(Point3f p, Vec3f wi) const {
        if (radius == 0) return {wi, 1};
        const Vec3f o = p - centre;
        const float r = radius_for(o);
        const Vec3f at = o / r;
        const float b = dot(at, wi);
        const float t = -b + std::sqrt(std::max(0.0f, b * b + (1 - dot(at, at))));
        const Vec3f w = at + t * wi;
        return {normalize(w), density(t, dot(w, wi))};
    }
    Mapped from_point(Point3f p, Vec3f w) const {
        if (radius == 0) return {w, 1};
        const Vec3f o = p - centre;
        const float r = radius_for(o);
        const Vec3f d = w - o / r;
        const float t = length(d);
        const Vec3f wi = d / t;
        return {wi, density(t, dot(w, wi))};
    }

  private:
    float radius_for(Vec3f o) const { return std::max(radius, 1.5f * length(o)); }
    // Of a piece of the sphere at the distance t, in radii.
    static float density(float t, float cosine) { return t * t / cosine; }
};

} // namespace montelux
