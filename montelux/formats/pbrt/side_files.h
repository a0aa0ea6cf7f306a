// SideFiles: the files that a written scene refers to, in a folder beside it, which appear together.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace montelux::pbrt {

// Files are written into a temporary folder, which commit() empties into "NAME-files" beside "NAME.pbrt". Without a
// commit nothing is left. The folder is made when there is a file.
class SideFiles {
  public:
    explicit SideFiles(const std::filesystem::path& scene_file);
    ~SideFiles();
    SideFiles(const SideFiles&) = delete;
    SideFiles& operator=(const SideFiles&) = delete;

    // Where to write the file of that name now. Throws Error where the folder cannot be made.
    std::filesystem::path add(const std::string& name);
    // How the scene names it.
    std::string reference(const std::string& name) const;
    // Replaces files of the same names. Returns the places of all.
    std::vector<std::filesystem::path> commit();

  private:
    std::filesystem::path folder_, temporary_;
    std::vector<std::string> names_;
};

} // namespace montelux::pbrt
