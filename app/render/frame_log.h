// FrameLog: which frames of a sequence are finished, and with which settings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "montelux/scene/content_digest.h"

namespace montelux::app {

// A text file beside the pictures, a line for each: hashes of its settings and of its bytes, its exposure, its name.
// Several processes may write frames of one sequence; at worst a line is lost, and its frame rendered again.
class FrameLog {
  public:
    // out.png -> out.frames. Throws Error where there is a file of that name that is no such log.
    explicit FrameLog(const std::string& output);

    const std::filesystem::path& path() const { return path_; }

    struct Finished {
        std::optional<float> exposure{}; // stops, of the first file that has one
    };
    // Empty unless all these files are as they were when they were written, with these settings.
    std::optional<Finished> find(const std::vector<std::string>& files, std::uint64_t settings) const;
    // Call after the files were written. Throws Error.
    void add(const std::vector<std::string>& files, std::uint64_t settings, std::optional<float> exposure);

  private:
    struct Entry {
        std::uint64_t settings = 0;
        ContentDigest content;
        std::optional<float> exposure{};
    };
    std::map<std::string, Entry> read() const;
    // Relative to the log's folder, so that the folder can be moved.
    std::string name_of(const std::string& file) const;

    std::filesystem::path path_;
};

} // namespace montelux::app
