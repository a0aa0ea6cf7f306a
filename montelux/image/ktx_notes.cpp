#include "montelux/image/ktx_notes.h"

#include <cstdio>

#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"

namespace montelux {

std::map<std::string, std::string> ktx_notes(std::string_view where, const TextureOptions& options,
                                             const std::string& orientation) {
    for (const auto& [key, text] : options.notes) {
        if (key.empty()) throw Error(where, "a note has an empty key");
        if (key.starts_with("KTX") || key.starts_with("ktx"))
            throw Error(where, "the note '" + key + "' has a key that KTX files keep for themselves");
        if (key.find('\0') != std::string::npos || text.find('\0') != std::string::npos)
            throw Error(where, "a note holds a zero byte");
    }
    auto notes = options.notes;
    notes["KTXorientation"] = orientation;
    notes["KTXwriter"] = "Montelux " MONTELUX_VERSION;
    if (options.format == TexelFormat::rgbm8) {
        char range[32];
        std::snprintf(range, sizeof range, "%.9g", options.rgbm.range);
        notes["montelux.rgbm.range"] = range;
        notes["montelux.rgbm.power"] = std::to_string(options.rgbm.power);
    }
    return notes;
}

std::vector<std::uint8_t> ktx_key_values(const std::map<std::string, std::string>& notes) {
    ByteWriter bytes;
    for (const auto& [key, text] : notes) {
        bytes.put(static_cast<std::uint32_t>(key.size() + text.size() + 2));
        bytes.put_all(std::span<const char>(key.c_str(), key.size() + 1));
        bytes.put_all(std::span<const char>(text.c_str(), text.size() + 1));
        while (bytes.size() % 4 != 0) bytes.put(std::uint8_t{0});
    }
    return bytes.take();
}

} // namespace montelux
