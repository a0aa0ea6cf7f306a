// The scenes of Mitsuba's repository among the shared files.
#pragma once

#include <filesystem>
#include <vector>

#include "montelux/formats/file_source.h"

namespace montelux::test {

inline std::filesystem::path mitsuba_scenes() {
    return (std::filesystem::path(MONTELUX_SHARED_DIR) / "scenes" / "mitsuba").lexically_normal();
}

// In that repository the tests lie one folder deeper, so that their "../../../common" is the folder of common files.
class MitsubaFiles final : public FileSource {
  public:
    bool exists(const std::filesystem::path& path) override { return disk_.exists(here(path)); }
    std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t max_bytes) override {
        return disk_.read(here(path), max_bytes);
    }

  private:
    static std::filesystem::path here(const std::filesystem::path& path) {
        const std::filesystem::path whole = path.lexically_normal();
        const std::filesystem::path name =
            whole.lexically_relative(mitsuba_scenes().parent_path() / "common");
        if (name.empty() || *name.begin() == "..") return whole;
        return mitsuba_scenes() / "common" / name;
    }

    DiskFiles disk_;
};

} // namespace montelux::test
