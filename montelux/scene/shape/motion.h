// Motion: a transformation that changes with time.
#pragma once

#include <span>
#include <vector>

#include "montelux/mc/math/transform.h"

namespace montelux {

// From one transformation at time 0 to another at time 1. Each is taken apart into a translation, a rotation and
// a stretch (M = T R S with symmetric S, the polar decomposition: Shoemake and Duff 1992, "Matrix Animation and
// Polar Decomposition"); the rotation turns at constant speed along the shorter way (Shoemake 1985, slerp), the
// others change linearly.
//
// That path is followed by chords between keys at equal distances of time, at most 128 of them and otherwise
// enough that points leave it by at most 1.2e-4 of their distance from the axis. The ray tracer interpolates the
// same keys, so points that are computed from a hit lie on the surface that was hit.
class Motion {
  public:
    // Both affine and invertible. Throws Error where the path between them is not invertible: from a mirrored
    // transformation to one that is not.
    Motion(const Transform& start, const Transform& end);

    const Transform& start() const { return start_; }
    const Transform& end() const { return end_; }
    // At time 0, ..., 1, with entries that are exact as floats; at least two.
    std::span<const Matrix4> keys() const { return keys_; }
    // Of matrices between keys: the largest magnitude of an entry's translation.
    double reach() const { return reach_; }
    // Time in [0, 1].
    Transform at(float time) const;

  private:
    Transform start_, end_;
    std::vector<Matrix4> keys_;
    double reach_ = 0;
};

} // namespace montelux
