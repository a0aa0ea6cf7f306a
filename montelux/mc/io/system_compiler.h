// Sources in C and C++ to shared libraries, by the system's compiler.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace montelux {

// A new folder for temporary files, which is removed with all it holds. Throws Error.
class BuildFolder {
  public:
    BuildFolder();
    ~BuildFolder();
    BuildFolder(const BuildFolder&) = delete;
    BuildFolder& operator=(const BuildFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

struct Compilation {
    enum class Language : std::uint8_t { c, cpp };
    enum class Messages : std::uint8_t {
        shown,   // go to standard error
        in_error // are a part of the Error
    };

    std::filesystem::path source, library; // what is read, and what is written
    Language language = Language::c;
    Messages messages = Messages::shown;
    std::vector<std::string> options = {};   // before those of the environment
    std::vector<std::string> overrides = {}; // after those of the environment
    std::string name = {};                   // of the source in errors; empty: its path
};

// $CC or cc, and $CXX or c++, translate it, with -O2 and the words of $CFLAGS or $CXXFLAGS. Throws Error.
void compile(const Compilation& c);

} // namespace montelux
