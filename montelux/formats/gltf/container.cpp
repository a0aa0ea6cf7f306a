#include "montelux/formats/gltf/container.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace montelux::gltf {
namespace {

constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
           static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

nlohmann::json parse(std::span<const std::uint8_t> text, const Diagnostics& diagnostics) {
    // A byte order mark is not allowed, but written by some editors; the parser skips it.
    try {
        return nlohmann::json::parse(text.begin(), text.end());
    } catch (const nlohmann::json::parse_error& e) {
        const std::size_t end = std::min(e.byte > 0 ? e.byte - 1 : 0, text.size());
        const auto line_begin =
            std::find(std::make_reverse_iterator(text.begin() + static_cast<std::ptrdiff_t>(end)),
                      text.rend(), std::uint8_t{'\n'});
        const auto column =
            std::distance(std::make_reverse_iterator(text.begin() + static_cast<std::ptrdiff_t>(end)),
                          line_begin) +
            1;
        const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n') + 1;
        // "[json.exception.parse_error.101] parse error at line 1, column 2: what is wrong"
        std::string what = e.what();
        if (const std::size_t colon = what.find(": "); colon != std::string::npos) what.erase(0, colon + 2);
        std::replace_if(
            what.begin(), what.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
        what.resize(std::min<std::size_t>(what.size(), 200));
        diagnostics.error("", "line " + std::to_string(line) + ", column " + std::to_string(column) +
                                  ": broken JSON: " + what);
    } catch (const nlohmann::json::exception& e) {
        diagnostics.error("", std::string("broken JSON: ") + e.what());
    }
}

} // namespace

Container open_container(std::vector<std::uint8_t> file, Diagnostics& diagnostics) {
    Container c{std::move(file), {}};
    const std::span<const std::uint8_t> bytes(c.bytes);
    if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) {
        c.json = std::make_shared<const nlohmann::json>(parse(bytes, diagnostics));
        return c;
    }
    if (bytes.size() < header_bytes + chunk_header_bytes)
        diagnostics.error("", "ends within the header of a binary glTF file");
    if (const std::uint32_t version = word(bytes, 4); version != 2)
        diagnostics.error("", "is version " + std::to_string(version) + " of binary glTF; expected 2");
    const std::size_t length = word(bytes, 8);
    if (length > bytes.size())
        diagnostics.error("", "has " + std::to_string(bytes.size()) + " bytes; its header says " +
                                  std::to_string(length));
    std::size_t at = header_bytes;
    bool found_json = false;
    while (at < length && length - at >= chunk_header_bytes) {
        const std::size_t size = word(bytes, at);
        const std::uint32_t type = word(bytes, at + 4);
        at += chunk_header_bytes;
        if (size > length - at)
            diagnostics.error("", "a chunk of " + std::to_string(size) + " bytes begins at byte " +
                                      std::to_string(at) + "; the file ends at " + std::to_string(length));
        const auto chunk = bytes.subspan(at, size);
        at += size;
        if (!found_json) {
            if (type != json_chunk) diagnostics.error("", "its first chunk is not JSON");
            c.json = std::make_shared<const nlohmann::json>(parse(chunk, diagnostics));
            found_json = true;
        } else if (type == binary_chunk && !c.chunk) {
            c.chunk = chunk;
        }
        // Chunks of other types are for later versions: they are to be skipped.
        at = std::min(length, (at + 3) / 4 * 4);
    }
    if (!found_json) diagnostics.error("", "has no JSON chunk");
    return c;
}

} // namespace montelux::gltf
