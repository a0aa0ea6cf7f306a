// Diagnostics: places in a scene file, and the errors and warnings that name them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "montelux/formats/warnings.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/build_messages.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::pbrt {

using Location = SourceLocation;

class Diagnostics final : public BuildMessages {
  public:
    explicit Diagnostics(Warnings& warnings) : warnings_(warnings) {}

    std::uint32_t add_file(std::string name);
    const std::string& file_name(std::uint32_t file) const { return files_[file]; }
    // "file:line:column"
    std::string describe(Location at) const override;

    void warn(Location at, std::string_view sentence) override;
    void warn_once(std::string_view key, Location at, std::string_view sentence) override;

  private:
    Warnings& warnings_;
    std::vector<std::string> files_;
    std::unordered_set<std::string> told_;
};

inline std::string printable(std::string_view text) { return shown(text); }
inline std::string in_quotes(std::string_view text) { return quoted(text); }

} // namespace montelux::pbrt
