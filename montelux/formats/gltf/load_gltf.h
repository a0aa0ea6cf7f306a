// Scenes in the format glTF 2.0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "montelux/formats/load_options.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// Reads a .gltf or .glb file with the content `bytes`, and the files in its folder that it refers to. What is read, and
// in which units: docs/gltf.md. Throws Error "file: /json/pointer: sentence" for what is broken, and for required
// extensions that are not supported; adds what it ignores to `warnings`.
SceneDescription load_gltf(std::vector<std::uint8_t> bytes, const std::filesystem::path& path,
                           Warnings& warnings, FileSource& source, const LoadOptions& options = {});

} // namespace montelux
