// SceneAndFile: an input that is a scene as text and, behind its first NUL byte, the content of every other file that the
// scene names (included scenes, meshes, pictures, spectra, grids), whatever the name. Nothing is read from the disk.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "montelux/formats/file_source.h"

namespace montelux {

class SceneAndFile final : public FileSource {
  public:
    // `name`: of the scene.
    SceneAndFile(const std::uint8_t* data, std::size_t size, std::filesystem::path name)
        : name_(std::move(name)) {
        const std::uint8_t *end = data + size, *nul = std::find(data, end, std::uint8_t{0});
        scene_.assign(data, nul);
        other_.assign(nul == end ? end : nul + 1, end);
    }

    bool exists(const std::filesystem::path&) override { return true; }
    std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t) override {
        return path == name_ ? scene_ : other_;
    }

  private:
    std::filesystem::path name_;
    std::vector<std::uint8_t> scene_, other_;
};

} // namespace montelux
