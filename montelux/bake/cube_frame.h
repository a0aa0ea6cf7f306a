// How a cube map stands in the world: which of its axes is up, and whether it is seen in a mirror.
#pragma once

#include "montelux/mc/math/vec.h"

namespace montelux {

// Without options a cube map is left-handed, as its files are: y up, the middle of an equirectangular map at
// +z and what lies to its right there at +x, so that each face shows the map unmirrored to who stands inside.
struct CubeFrame {
    bool z_up = false; // z up, the middle of the map at +x and its right at +y, left-handed as well
    bool mirrored =
        false;       // x (with z up: y) the other way: for programs that look up with right-handed directions
    double turn = 0; // degrees: the place of the middle is taken by what lies so far to its right

    // Unit vector in the map's frame (environment_map.h) for one of the cube, and the way back.
    Vec3d to_map(Vec3d cube) const;
    Vec3d from_map(Vec3d map) const;
};

} // namespace montelux
