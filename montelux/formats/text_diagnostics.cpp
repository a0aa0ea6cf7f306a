#include "montelux/formats/text_diagnostics.h"

#include <utility>

namespace montelux {

std::uint32_t TextDiagnostics::add_file(std::string name) {
    files_.push_back(std::move(name));
    return static_cast<std::uint32_t>(files_.size() - 1);
}

std::string TextDiagnostics::describe(SourceLocation at) const {
    return files_[at.file] + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
}

void TextDiagnostics::warn(SourceLocation at, std::string_view sentence) {
    warnings_.add(describe(at), sentence);
}

void TextDiagnostics::warn_once(std::string_view key, SourceLocation at, std::string_view sentence) {
    if (told_.size() < Warnings::max_messages && told_.insert(std::string(key)).second) warn(at, sentence);
}

} // namespace montelux
