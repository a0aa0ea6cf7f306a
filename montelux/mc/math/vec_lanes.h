// Single vectors in and out of vectors of lanes.
#pragma once

#include "montelux/mc/math/lanes.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

template <int W>
void set_lane(Vec3<Lanes<W>>& v, int lane, Vec3f value) {
    v.x.set(lane, value.x);
    v.y.set(lane, value.y);
    v.z.set(lane, value.z);
}
template <int W>
Vec3f lane_of(const Vec3<Lanes<W>>& v, int lane) {
    return {v.x[lane], v.y[lane], v.z[lane]};
}

} // namespace montelux
