// Where something stands in a scene file, and how errors and warnings about it are told.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "montelux/formats/warnings.h"
#include "montelux/mc/math/error.h"

namespace montelux::pbrt {

// Lines and columns count from 1; columns count bytes.
struct Location {
    std::uint32_t file = 0, line = 1, column = 1;
};

// An error that says where in the scene file it is. Readers of other files throw plain ones, which become
// located ones where the scene file names the file.
class LocatedError : public Error {
  public:
    using Error::Error;
};

class Diagnostics {
  public:
    explicit Diagnostics(Warnings& warnings) : warnings_(warnings) {}

    std::uint32_t add_file(std::string name);
    const std::string& file_name(std::uint32_t file) const { return files_[file]; }
    // "file:line:column"
    std::string describe(Location at) const;

    // Throws LocatedError "file:line:column: sentence".
    [[noreturn]] void error(Location at, std::string_view sentence) const;
    void warn(Location at, std::string_view sentence);
    // Tells only the first of all warnings with the same key.
    void warn_once(std::string_view key, Location at, std::string_view sentence);

  private:
    Warnings& warnings_;
    std::vector<std::string> files_;
    std::unordered_set<std::string> told_;
};

// Text of a file as it may stand in a message: at most 40 bytes, with what cannot be printed as '?'.
std::string printable(std::string_view text);

// "'text'"
inline std::string in_quotes(std::string_view text) { return "'" + printable(text) + "'"; }

} // namespace montelux::pbrt
