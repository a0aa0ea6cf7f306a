// LoadOptions: what a user asks of a scene file beside its path.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/image/texel_file.h"

namespace montelux {

struct LoadOptions {
    // Receives every file that was read, so that no picture overwrites one.
    std::vector<std::filesystem::path>* files_read = nullptr;
    FileSource* source = nullptr;            // null: the disk
    std::shared_ptr<TexelFile> texel_file{}; // becomes Scene::texel_file
};

} // namespace montelux
