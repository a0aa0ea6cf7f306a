#include "montelux/formats/gltf/diagnostics.h"

namespace montelux::gltf {
namespace {

std::string joined(const std::string& file, const std::string& pointer) {
    return pointer.empty() ? file : file + ": " + pointer;
}

} // namespace

SourceLocation Diagnostics::place(std::string pointer) {
    if (pointers_.back() != pointer) pointers_.push_back(std::move(pointer));
    return {.file = 0, .line = static_cast<std::uint32_t>(pointers_.size()), .column = 1};
}

std::string Diagnostics::describe(SourceLocation at) const { return joined(file_, pointers_[at.line - 1]); }

void Diagnostics::error(const std::string& pointer, std::string_view sentence) const {
    throw LocatedError(joined(file_, pointer), sentence);
}

void Diagnostics::warn(const std::string& pointer, std::string_view sentence) {
    warnings_.add(joined(file_, pointer), sentence);
}

void Diagnostics::warn_once(std::string_view key, const std::string& pointer, std::string_view sentence) {
    if (told_.insert(std::string(key)).second) warn(pointer, sentence);
}

} // namespace montelux::gltf
