// Motion: a transformation that changes with time.
#pragma once

#include <span>
#include <vector>

#include "montelux/mc/math/transform.h"

namespace montelux {

// From one transformation at time 0 to another at time 1, along a MotionPath or the product of two.
//
// The path is followed by chords between keys at equal distances of time, at most 128 of them and otherwise
// enough that points leave it by at most 1.2e-4 of their distance from the axis. The ray tracer interpolates the
// same keys, so points that are computed from a hit lie on the surface that was hit.
class Motion {
  public:
    // Both affine and invertible. Throws Error where the path between them is not invertible: from a mirrored
    // transformation to one that is not.
    Motion(const Transform& start, const Transform& end);

    // Of what moves by `inner` in a space that is placed by `outer`: outer * inner at each time, which is not the
    // path between the products of the ends. Neither may be a product itself.
    static Motion product(const Transform& outer, const Motion& inner);
    // The tolerance is a share of the distance from the axis of `inner`, and of the largest distance of that axis from
    // the one of `outer`.
    static Motion product(const Motion& outer, const Motion& inner);

    const Transform& start() const { return start_; }
    const Transform& end() const { return end_; }
    // Otherwise it follows from its ends.
    bool is_product() const { return is_product_; }
    // At time 0, ..., 1, with entries that are exact as floats; at least two.
    std::span<const Matrix4> keys() const { return keys_; }
    // Of matrices between keys: the largest magnitude of an entry's translation.
    double reach() const { return reach_; }
    // Time in [0, 1].
    Transform at(float time) const;

  private:
    Motion() = default;
    // Of `count` chords; `of_time` returns the matrix at a time.
    template <typename F>
    void add_keys(int count, const F& of_time);

    Transform start_, end_;
    bool is_product_ = false;
    std::vector<Matrix4> keys_;
    double reach_ = 0;
};

} // namespace montelux
