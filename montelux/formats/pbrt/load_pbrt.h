// Scenes in the format of pbrt-v4.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// Reads a pbrt-v4 scene file (gzipped when its name ends in ".gz") and all files that it refers to. Paths are
// relative to its folder. What is supported, what is left out and what differs stands in docs/pbrt.md.
// Throws Error "file:line:column: sentence" on anything that pbrt would not understand or that Montelux
// cannot render; tells of what it ignores in `warnings`. `files_read`, where given, gets every file that the
// scene was read from: what a picture must not be written over.
// `source` stands in for the disk.
SceneDescription load_pbrt(const std::filesystem::path& path, Warnings& warnings,
                           std::vector<std::filesystem::path>* files_read = nullptr,
                           FileSource* source = nullptr);

// The same for a file of which `bytes` is the unpacked content.
SceneDescription load_pbrt(std::vector<std::uint8_t> bytes, const std::filesystem::path& path,
                           Warnings& warnings, std::vector<std::filesystem::path>* files_read,
                           FileSource& source);

// The same for a text; `name` stands in messages and `folder` is where paths start.
SceneDescription parse_pbrt(std::string_view text, const std::string& name,
                            const std::filesystem::path& folder, Warnings& warnings);

} // namespace montelux
