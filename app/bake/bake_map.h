// What the commands that bake an environment map have in common: its file, its layout, how the cube stands.
#pragma once

#include <string>

#include "montelux/bake/cube_frame.h"
#include "montelux/bake/environment_map.h"

namespace CLI {
class App;
}

namespace montelux::app {

struct BakeMapOptions {
    std::string file, layout = "auto", up = "y";
    bool mirror = false;
    double turn = 0;
};

void declare(CLI::App& command, BakeMapOptions& options);
CubeFrame frame_of(const BakeMapOptions& options);
// Warns of changes and guesses unless `quiet`. Errors name the file.
EnvironmentMap read_map(const BakeMapOptions& options, bool quiet);

} // namespace montelux::app
