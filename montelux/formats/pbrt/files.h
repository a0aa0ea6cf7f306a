// The files of a pbrt scene: names are relative to the folder of the main scene file, as in pbrt.
#pragma once

#include "montelux/formats/pbrt/diagnostics.h"
#include "montelux/formats/scene_files.h"

namespace montelux::pbrt {

using Files = SceneFiles;

} // namespace montelux::pbrt
