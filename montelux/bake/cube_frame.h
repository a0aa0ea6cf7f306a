// Orientation of a cube map in the world: its up axis, and mirroring.
#pragma once

#include "montelux/mc/math/vec.h"

namespace montelux {

// Without options a cube map is left-handed, as its files are: y up, the middle of an equirectangular map at
// +z and its right at +x, so that each face, seen from inside, shows the map unmirrored.
struct CubeFrame {
    bool z_up = false; // z up, the middle of the map at +x and its right at +y, left-handed as well
    bool mirrored =
        false;       // x (with z up: y) the other way: for programs that look up with right-handed directions
    double turn = 0; // degrees: moves this far right of the middle to the middle

    // Unit vector in the map's frame (environment_map.h) for one of the cube, and back.
    Vec3d to_map(Vec3d cube) const;
    Vec3d from_map(Vec3d map) const;
};

} // namespace montelux
