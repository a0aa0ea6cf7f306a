// Scenes of an OBJ file and the MTL files that it names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "montelux/formats/load_options.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// A model_description (mesh_scene.h) of the file with the content `bytes`, with a shape for each part. Faces without
// material, or with one that no MTL file has, are model_material. Throws Error for the errors of parse_obj and
// parse_mtl, and for files without faces; files and pictures that are missing are warnings.
SceneDescription load_obj(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                          Warnings& warnings, const LoadOptions& options);

} // namespace montelux
