// The files that a scene refers to: found, read whole, and listed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/pbrt/diagnostics.h"

namespace montelux::pbrt {

// Relative names are looked for in the folder of the main scene file, as pbrt does, then in the folder of the
// file that mentions them.
class Files {
  public:
    // Both must outlive it.
    Files(std::filesystem::path main_folder, FileSource& source, Diagnostics& diagnostics)
        : main_folder_(std::move(main_folder)), source_(source), diagnostics_(diagnostics) {}

    // An error at `at` when there is no such file.
    std::filesystem::path find(std::string_view name, Location at) const;
    // The whole file; one whose name ends in ".gz" is decompressed.
    std::vector<std::uint8_t> read(const std::filesystem::path& path, Location at);

    // Every file that was read, in order.
    const std::vector<std::filesystem::path>& files_read() const { return files_read_; }
    void count_as_read(const std::filesystem::path& path) { files_read_.push_back(path); }

  private:
    std::filesystem::path main_folder_;
    FileSource& source_;
    Diagnostics& diagnostics_;
    std::vector<std::filesystem::path> files_read_;
};

} // namespace montelux::pbrt
