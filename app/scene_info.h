// What montelux info prints of a scene file.
#pragma once

#include <map>
#include <string>

namespace montelux::app {

// Loads the scene and prints it, as JSON or as text: counts by kind, bounds, memory, camera, film, settings, files and
// what was ignored.
// `definitions`: LoadOptions::definitions.
void print_scene_info(const std::string& file, const std::map<std::string, std::string>& definitions,
                      bool json);

} // namespace montelux::app
