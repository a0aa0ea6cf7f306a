// MotionPath: the exact path of a motion between two transformations.
#pragma once

#include <array>

#include "montelux/mc/math/transform.h"

namespace montelux {

// Each end is taken apart into a translation, a rotation and a stretch (M = T R S with symmetric S, the polar
// decomposition: Shoemake and Duff 1992, "Matrix Animation and Polar Decomposition"); the rotation turns at constant
// speed along the shorter way (Shoemake 1985, slerp), the others change linearly.
class MotionPath {
  public:
    // Both affine and invertible. Throws Error where one of them is mirrored and the other is not.
    MotionPath(const Transform& start, const Transform& end);

    // Time in [0, 1].
    Matrix4 at(double t) const;
    // How many chords between equal distances of time leave it by at most that share of the distance from the axis;
    // at least one.
    int chords(double tolerance) const;

    using Linear = std::array<std::array<double, 3>, 3>;
    struct Quaternion {
        double x = 0, y = 0, z = 0, w = 1;
    };
    struct Parts {
        Vec3d translation;
        Quaternion rotation;
        Linear stretch;
    };

  private:
    Parts start_, end_;
    double angle_ = 0; // between the quaternions
};

} // namespace montelux
