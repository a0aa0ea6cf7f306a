// Sensors of a Mitsuba scene: camera, film and sampler of a SceneDescription.
#pragma once

#include "montelux/formats/mitsuba/media.h"
#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/scene/render_settings.h"

namespace montelux::mitsuba {

void read_sensor(Plugin sensor, MediumLibrary& media, SceneDescription& description);

// Angle across the width of a picture, degrees, from 'fov' and 'fov_axis' or 'focal_length'. `aspect`: width over
// height.
double horizontal_fov(Plugin& plugin, double aspect);
// From the space of our cameras, whose x axis points to the right, to that of Mitsuba's, where it points to the left.
Transform mirrored_camera();

} // namespace montelux::mitsuba
