// SceneDisk: the disk through which light from infinity enters the scene.
#pragma once

#include "montelux/mc/math/vec.h"
#include "montelux/scene/shape/bounds.h"
#include "montelux/scene/shape/ray.h"

namespace montelux {

// A disk across the beam that covers the bounding sphere of the scene, just outside it.
class SceneDisk {
  public:
    explicit SceneDisk(const Bounds3& bounds);

    double area() const;
    // Per area; the disk is sampled uniformly.
    float pdf() const { return static_cast<float>(1 / area()); }
    // Along the unit vector w.
    Ray sample(Vec3f w, Vec2f u) const;
    // The ray along the unit vector w through `p`, which starts outside the scene.
    Ray through(Vec3d p, Vec3f w) const;

  private:
    Vec3d center_;
    double radius_;
};

} // namespace montelux
