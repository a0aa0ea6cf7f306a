#include "montelux/formats/gltf/uri.h"

#include <algorithm>
#include <array>
#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::gltf {
namespace {

constexpr std::uint8_t no_digit = 255;

constexpr std::array<std::uint8_t, 256> base64_digits = [] {
    std::array<std::uint8_t, 256> digits{};
    digits.fill(no_digit);
    constexpr std::string_view all = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < all.size(); ++i)
        digits[static_cast<unsigned char>(all[i])] = static_cast<std::uint8_t>(i);
    return digits;
}();

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string without_escapes(std::string_view uri) {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            name += uri[i];
            continue;
        }
        const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1,
                  low = high >= 0 ? hex_digit(uri[i + 2]) : -1;
        if (low < 0) throw Error("the URI " + quoted(uri) + " has a '%' without two hexadecimal digits");
        name += static_cast<char>(16 * high + low);
        i += 2;
    }
    return name;
}

} // namespace

std::vector<std::uint8_t> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        throw Error("a data URI that is not in base64");
    std::string_view text = uri.substr(comma + 1);
    while (text.ends_with('=')) text.remove_suffix(1);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const std::uint8_t digit = base64_digits[static_cast<unsigned char>(c)];
        if (digit == no_digit) throw Error("a data URI with a character that is not base64");
        bits = bits << 6 | digit;
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::uint8_t>(bits >> count));
        }
    }
    return bytes;
}

std::filesystem::path file_of_uri(std::string_view uri) {
    if (uri.empty()) throw Error("an empty URI");
    const std::size_t colon = uri.find(':');
    if (colon != std::string_view::npos && colon < uri.find('/'))
        throw Error("the URI " + quoted(uri) + " is not a file; expected a relative name or a data URI");
    const std::string name = without_escapes(uri);
    if (name.find('\0') != std::string::npos) throw Error("the URI " + quoted(uri) + " has a NUL byte");
    const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
    if (path.is_absolute() || path.begin() == path.end() || *path.begin() == "..")
        throw Error("the URI " + quoted(uri) +
                    " leads out of the folder of the glTF file; such files are not read");
    return path;
}

} // namespace montelux::gltf
