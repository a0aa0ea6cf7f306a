// FileMessages: errors and warnings of readers of line-based or binary files: "file:line".
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "montelux/formats/warnings.h"
#include "montelux/scene/build/build_messages.h"

namespace montelux {

class FileMessages final : public BuildMessages {
  public:
    // The first file is number 0.
    FileMessages(std::string file, Warnings& warnings) : warnings_(warnings) { add_file(std::move(file)); }

    std::uint32_t add_file(std::string name) {
        files_.push_back(std::move(name));
        return static_cast<std::uint32_t>(files_.size() - 1);
    }
    // Line 0: the file as a whole.
    std::string describe(SourceLocation at) const override {
        return files_[at.file] + (at.line > 0 ? ":" + std::to_string(at.line) : "");
    }
    void warn(SourceLocation at, std::string_view sentence) override {
        warnings_.add(describe(at), sentence);
    }
    void warn_once(std::string_view key, SourceLocation at, std::string_view sentence) override {
        if (told_.size() < Warnings::max_messages && told_.insert(std::string(key)).second)
            warn(at, sentence);
    }

  private:
    Warnings& warnings_;
    std::vector<std::string> files_;
    std::unordered_set<std::string> told_;
};

} // namespace montelux
