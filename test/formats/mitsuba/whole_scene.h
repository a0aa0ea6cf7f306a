// Whole Mitsuba scenes from texts: what they load as, with what warnings, and the error of a broken one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "montelux/formats/mitsuba/load_mitsuba.h"
#include "montelux/mc/math/error.h"

namespace montelux::test {

using FileContents = std::map<std::string, std::vector<std::uint8_t>>; // by name

inline std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

// Files in memory: a scene that has none but these.
class NamedFiles final : public FileSource {
  public:
    explicit NamedFiles(FileContents files) : files_(std::move(files)) {}

    bool exists(const std::filesystem::path& path) override {
        return files_.contains(path.lexically_normal().string());
    }
    std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t) override {
        return files_.at(path.lexically_normal().string());
    }

  private:
    FileContents files_;
};

struct WholeScene {
    SceneDescription description;
    std::vector<std::string> warnings;

    const Scene& scene() const { return description.scene; }
    bool warns(std::string_view part) const {
        return std::ranges::any_of(warnings,
                                   [&](const std::string& w) { return w.find(part) != std::string::npos; });
    }
};

inline WholeScene load_scene_text(std::string_view content, FileContents files = {},
                                  const LoadOptions& options = {}) {
    const std::string text = "<scene version=\"3.0.0\">" + std::string(content) + "</scene>";
    NamedFiles source(std::move(files));
    Warnings warnings;
    WholeScene loaded;
    loaded.description = load_mitsuba(bytes_of(text), "scene.xml", warnings, source, options);
    loaded.warnings = warnings.messages();
    return loaded;
}

// What the error says; empty without one.
inline std::string scene_text_error(std::string_view content, FileContents files = {},
                                    const LoadOptions& options = {}) {
    try {
        load_scene_text(content, std::move(files), options);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

} // namespace montelux::test
