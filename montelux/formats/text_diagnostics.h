// TextDiagnostics: places in the text files of a scene, and the errors and warnings that name them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "montelux/formats/warnings.h"
#include "montelux/scene/build/build_messages.h"

namespace montelux {

class TextDiagnostics final : public BuildMessages {
  public:
    explicit TextDiagnostics(Warnings& warnings) : warnings_(warnings) {}

    std::uint32_t add_file(std::string name);
    const std::string& file_name(std::uint32_t file) const { return files_[file]; }
    // "file:line:column"
    std::string describe(SourceLocation at) const override;

    void warn(SourceLocation at, std::string_view sentence) override;
    void warn_once(std::string_view key, SourceLocation at, std::string_view sentence) override;

  private:
    Warnings& warnings_;
    std::vector<std::string> files_;
    std::unordered_set<std::string> told_;
};

} // namespace montelux
