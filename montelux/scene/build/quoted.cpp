#include "montelux/scene/build/quoted.h"

#include <algorithm>

namespace montelux {
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

std::string shown(std::string_view text) {
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

} // namespace montelux
