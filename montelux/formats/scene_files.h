// SceneFiles: the files that a scene refers to: found, read whole, and listed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/text_diagnostics.h"

namespace montelux {

// Relative names are looked for in the folders that the scene names, the latest one first, in the folder of the main
// scene file, and in that of the file that mentions them; where there is none, with slashes in place of backslashes.
class SceneFiles {
  public:
    // Both must outlive it.
    SceneFiles(std::filesystem::path main_folder, FileSource& source, TextDiagnostics& diagnostics)
        : main_folder_(std::move(main_folder)), source_(source), diagnostics_(diagnostics) {}

    void add_folder(std::filesystem::path folder) { folders_.push_back(std::move(folder)); }

    // An error at `at` when there is no such file.
    std::filesystem::path find(std::string_view name, SourceLocation at) const;
    // The whole file; one whose name ends in ".gz" is decompressed.
    std::vector<std::uint8_t> read(const std::filesystem::path& path, SourceLocation at);

    // Every file that was read, in order.
    const std::vector<std::filesystem::path>& files_read() const { return files_read_; }
    void count_as_read(const std::filesystem::path& path) { files_read_.push_back(path); }

  private:
    std::filesystem::path main_folder_;
    std::vector<std::filesystem::path> folders_;
    FileSource& source_;
    TextDiagnostics& diagnostics_;
    std::vector<std::filesystem::path> files_read_;
};

} // namespace montelux
