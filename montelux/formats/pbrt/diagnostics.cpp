#include "montelux/formats/pbrt/diagnostics.h"

#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux::pbrt {

std::uint32_t Diagnostics::add_file(std::string name) {
    files_.push_back(std::move(name));
    return static_cast<std::uint32_t>(files_.size() - 1);
}

std::string Diagnostics::describe(Location at) const {
    return files_[at.file] + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
}

void Diagnostics::warn(Location at, std::string_view sentence) { warnings_.add(describe(at), sentence); }

void Diagnostics::warn_once(std::string_view key, Location at, std::string_view sentence) {
    if (told_.size() < Warnings::max_messages && told_.insert(std::string(key)).second) warn(at, sentence);
}

} // namespace montelux::pbrt
