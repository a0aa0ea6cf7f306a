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
    // The number of chords, of equal times, with which each point stays within `tolerance` times its distance from the
    // axis of the path; at least one.
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
    // By which share of what it is in `from`, one of the ends, the stretch changes on the way.
    double change_of_stretch(const Linear& from) const;

    Parts start_, end_;
    double angle_ = 0; // between the quaternions
};

// A bound of the spectral norm of the linear part.
double norm_of(const Matrix4& m);

} // namespace montelux
