// Rectangles and wavelengths for the tests of portals.
#pragma once

#include <array>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/light/portal.h"
#include "montelux/spectrum/wavelengths.h"

namespace montelux::portals {

inline const SampledWavelengths wavelengths = SampledWavelengths::sample_visible(0.37f);

// Light from +z through the rectangle [x0, x1] x [y0, y1] of the plane at height z, then rotated.
inline std::array<Point3f, 4> corners_of(float x0, float y0, float x1, float y1, float z = 0,
                                         const Transform& t = {}) {
    return {t.point(Point3f{x0, y0, z}), t.point(Point3f{x0, y1, z}), t.point(Point3f{x1, y1, z}),
            t.point(Point3f{x1, y0, z})};
}

} // namespace montelux::portals
