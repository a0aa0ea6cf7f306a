// What montelux info prints of a scene file.
#pragma once

#include <string>

#include "montelux/formats/load_options.h"

namespace montelux::app {

// Loads the scene and prints it, as JSON or as text: counts by kind, bounds, memory, cameras, variants and animations,
// film, settings, files and what was ignored.
void print_scene_info(const std::string& file, LoadOptions options, bool json);

} // namespace montelux::app
