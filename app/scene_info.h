// What montelux info prints of a scene file.
#pragma once

#include <string>

namespace montelux::app {

// Loads the scene and prints it, as JSON or as text: counts by kind, bounds, memory, camera, film, settings, files and
// what was ignored.
void print_scene_info(const std::string& file, bool json);

} // namespace montelux::app
