// load_scene: scene files of any supported format; at present pbrt-v4.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// The format is recognised by the file's content, not by its name; only compressed files need the suffix
// ".gz". Throws Error for files of other kinds, with their kind, and for the errors of the reader
// (pbrt/load_pbrt.h, which explains the other arguments).
SceneDescription load_scene(const std::filesystem::path& path, Warnings& warnings,
                            std::vector<std::filesystem::path>* files_read = nullptr,
                            FileSource* source = nullptr, std::shared_ptr<TexelFile> texel_file = nullptr);

} // namespace montelux
