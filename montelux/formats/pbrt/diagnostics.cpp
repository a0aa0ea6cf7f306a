#include "montelux/formats/pbrt/diagnostics.h"

#include <algorithm>
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

void Diagnostics::error(Location at, std::string_view sentence) const {
    throw LocatedError(describe(at), sentence);
}

void Diagnostics::warn(Location at, std::string_view sentence) { warnings_.add(describe(at), sentence); }

void Diagnostics::warn_once(std::string_view key, Location at, std::string_view sentence) {
    if (told_.size() < Warnings::max_messages && told_.insert(std::string(key)).second) warn(at, sentence);
}

namespace {

// Bytes of the UTF-8 character that `text` begins with; 0 when it is none, or a control character.
std::size_t character_length(std::string_view text) {
    auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    unsigned first = byte(0);
    if (first < 0x80) return first < 0x20 || first == 0x7f ? 0 : 1;
    std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    bool c1_control = first == 0xc2 && byte(1) < 0xa0;
    return c1_control ? 0 : length;
}

} // namespace

std::string printable(std::string_view text) {
    constexpr std::size_t limit = 40;
    std::string result;
    while (!text.empty() && result.size() < limit) {
        std::size_t length = character_length(text);
        result += length ? text.substr(0, length) : "?";
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    if (!text.empty()) result += "...";
    return result;
}

} // namespace montelux::pbrt
