// Scenes in the format of pbrt-v4.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// Reads a pbrt-v4 scene file (gzipped when its name ends in ".gz") and all files that it refers to. Paths are
// relative to its folder. Supported features and differences: docs/pbrt.md. Throws Error "file:line:column:
// sentence" for syntax that pbrt would reject and features that Montelux cannot render; adds what it ignores
// to `warnings`. `files_read`, if given, receives every file that was read, so that no picture overwrites
// one. `source` replaces the disk. `texel_file` becomes Scene::texel_file.
SceneDescription load_pbrt(const std::filesystem::path& path, Warnings& warnings,
                           std::vector<std::filesystem::path>* files_read = nullptr,
                           FileSource* source = nullptr, std::shared_ptr<TexelFile> texel_file = nullptr);

// The same for a file with the unpacked content `bytes`.
SceneDescription load_pbrt(std::vector<std::uint8_t> bytes, const std::filesystem::path& path,
                           Warnings& warnings, std::vector<std::filesystem::path>* files_read,
                           FileSource& source, std::shared_ptr<TexelFile> texel_file = nullptr);

// The same for a text; messages call it `name`, paths are relative to `folder`.
SceneDescription parse_pbrt(std::string_view text, const std::string& name,
                            const std::filesystem::path& folder, Warnings& warnings,
                            std::shared_ptr<TexelFile> texel_file = nullptr);

} // namespace montelux
