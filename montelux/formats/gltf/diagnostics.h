// Diagnostics: places in a glTF file as JSON pointers, and the errors and warnings that name them.
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "montelux/formats/warnings.h"
#include "montelux/scene/build/build_messages.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::gltf {

class Diagnostics final : public BuildMessages {
  public:
    Diagnostics(std::string file, Warnings& warnings) : file_(std::move(file)), warnings_(warnings) {}

    const std::string& file() const { return file_; }
    // A place for the SceneBuilder. `pointer` as in RFC 6901: "/meshes/0"; empty: the file.
    SourceLocation place(std::string pointer);

    std::string describe(SourceLocation at) const override;
    void warn(SourceLocation at, std::string_view sentence) override {
        warn(pointers_[at.line - 1], sentence);
    }
    void warn_once(std::string_view key, SourceLocation at, std::string_view sentence) override {
        warn_once(key, pointers_[at.line - 1], sentence);
    }

    [[noreturn]] void error(const std::string& pointer, std::string_view sentence) const;
    void warn(const std::string& pointer, std::string_view sentence);
    void warn_once(std::string_view key, const std::string& pointer, std::string_view sentence);

  private:
    std::string file_;
    Warnings& warnings_;
    std::vector<std::string> pointers_{""}; // of places; SourceLocation::line counts them from 1
    std::unordered_set<std::string> told_;
};

using montelux::in_quotes;

} // namespace montelux::gltf
