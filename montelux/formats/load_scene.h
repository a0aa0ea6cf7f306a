// load_scene: scene files of any supported format: pbrt-v4, glTF 2.0, and meshes by themselves (OBJ, PLY, STL).
#pragma once

#include <filesystem>

#include "montelux/formats/load_options.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// The format is recognised by the file's content, not by its name; only compressed files need the suffix
// ".gz". What models lack is left to add_studio (studio.h). Throws Error for files of other kinds, with their kind, and for the errors of the reader.
SceneDescription load_scene(const std::filesystem::path& path, Warnings& warnings,
                            const LoadOptions& options = {});

} // namespace montelux
