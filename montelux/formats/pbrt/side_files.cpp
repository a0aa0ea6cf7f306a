#include "montelux/formats/pbrt/side_files.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "montelux/mc/math/error.h"

namespace montelux::pbrt {

namespace fs = std::filesystem;

SideFiles::SideFiles(const fs::path& scene_file)
    : folder_(scene_file.parent_path() / (scene_file.stem().string() + "-files")) {}

SideFiles::~SideFiles() {
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

fs::path SideFiles::add(const std::string& name) {
    if (temporary_.empty()) {
        std::string pattern = (folder_.parent_path() / ".montelux-XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr)
            throw Error(folder_.string(), std::string("cannot be made: ") + std::strerror(errno));
        temporary_ = pattern;
    }
    names_.push_back(name);
    return temporary_ / name;
}

std::string SideFiles::reference(const std::string& name) const {
    return folder_.filename().string() + "/" + name;
}

std::vector<fs::path> SideFiles::commit() {
    std::vector<fs::path> places;
    if (names_.empty()) return places;
    std::error_code error;
    fs::create_directories(folder_, error);
    for (const std::string& name : names_) {
        places.push_back(folder_ / name);
        if (!error) fs::rename(temporary_ / name, places.back(), error);
        if (error) throw Error(places.back().string(), "cannot be written: " + error.message());
    }
    return places;
}

} // namespace montelux::pbrt
