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

void Diagnostics::error(Location at, std::string_view sentence) const { throw Error(describe(at), sentence); }

void Diagnostics::warn(Location at, std::string_view sentence) { warnings_.add(describe(at), sentence); }

void Diagnostics::warn_once(std::string_view key, Location at, std::string_view sentence) {
    if (told_.size() < Warnings::max_messages && told_.insert(std::string(key)).second) warn(at, sentence);
}

std::string printable(std::string_view text) {
    constexpr std::size_t limit = 40;
    std::string result;
    for (char c : text.substr(0, limit)) {
        bool control = static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f;
        result += control ? '?' : c;
    }
    if (text.size() > limit) result += "...";
    return result;
}

} // namespace montelux::pbrt
