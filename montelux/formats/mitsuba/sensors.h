// Sensors of a Mitsuba scene: camera, film and sampler of a SceneDescription.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "montelux/formats/mitsuba/media.h"
#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/scene/render_settings.h"

namespace montelux::mitsuba {

// The one that `asked` names by its id or by its number from 0, or the first one. An Error at `scene` where there is no
// such sensor.
const Plugin& choose_sensor(const std::vector<Plugin>& sensors, const std::optional<std::string>& asked,
                            const Plugin& scene);
void read_sensor(Plugin sensor, MediumLibrary& media, SceneDescription& description);

// Angle across the width of a picture, degrees, from 'fov' and 'fov_axis' or 'focal_length'. `aspect`: width over
// height.
double horizontal_fov(Plugin& plugin, double aspect);
// From the space of our cameras, whose x axis points to the right, to that of Mitsuba's, where it points to the left.
Transform mirrored_camera();

} // namespace montelux::mitsuba
