// Curves of a Mitsuba scene: text files of control points with radii.
#pragma once

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/scene/shape/curves.h"

namespace montelux::mitsuba {

// Of a bsplinecurve or linearcurve: x, y, z and radius on each line; empty lines separate curves. Radii are linear along
// each segment, and no transformation changes them.
Curves read_curves(Plugin& shape, const Transform& to_world);

} // namespace montelux::mitsuba
