// SceneAndFile: an input that is a scene as text and, behind its first NUL byte, the content of every other file that the
// scene names (included scenes, meshes, pictures, spectra, grids), whatever the name. Nothing is read from the disk.
#pragma once

#include "test/fuzz/fuzz_target.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/load_scene.h"
#include "montelux/formats/warnings.h"

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

// Loads the input as a scene of that name, or refuses it. libFuzzer leaves out inputs with one of `slow_words`: what they
// name takes seconds under sanitizers.
inline int read_or_refuse_scene(const std::uint8_t* data, std::size_t size, const std::filesystem::path& name,
                                [[maybe_unused]] std::initializer_list<std::string_view> slow_words) {
#ifdef MONTELUX_FUZZ
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    for (const std::string_view word : slow_words)
        if (text.find(word) != std::string_view::npos) return 0;
#endif
    SceneAndFile files(data, size, name);
    return read_or_refuse([&] {
        Warnings warnings;
        load_scene(name, warnings, {.source = &files});
    });
}

} // namespace montelux
