// Scenes from files of any format that Montelux reads, which today is that of pbrt-v4.
#pragma once

#include <filesystem>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// The format is recognised by the file's content, whatever its name; only compressed files need the ending
// ".gz". Throws Error for files of other kinds, with what they look like, and as the reader of the format
// does (pbrt/load_pbrt.h, where the other arguments are explained).
SceneDescription load_scene(const std::filesystem::path& path, Warnings& warnings,
                            std::vector<std::filesystem::path>* files_read = nullptr,
                            FileSource* source = nullptr);

} // namespace montelux
