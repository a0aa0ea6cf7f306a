// The headers of an OpenEXR file: parsed with every length and value checked, internal to the image room.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "montelux/image/decoders.h"
#include "montelux/mc/math/error.h"

namespace montelux {

struct ExrChannel {
    std::string name;
    int type; // 0 uint, 1 half, 2 float
};

struct ExrBox {
    std::int64_t min_x = 0, min_y = 0, max_x = 0, max_y = 0;
};

struct ExrTiles {
    std::uint32_t width, height;
    int level_mode; // 0 one level, 1 mipmap, 2 ripmap
    bool round_up;
};

struct ExrPart {
    std::optional<ExrBox> data_window, display_window;
    std::optional<int> compression, chunk_count;
    std::optional<ExrTiles> tiles;
    std::optional<std::string> type;
    std::vector<ExrChannel> channels;
    std::uint64_t pixel_bytes = 0; // of one pixel, as stored
    Attributes attributes;

    // Only with a data window.
    std::uint64_t width() const {
        return static_cast<std::uint64_t>(data_window->max_x - data_window->min_x + 1);
    }
    std::uint64_t height() const {
        return static_cast<std::uint64_t>(data_window->max_y - data_window->min_y + 1);
    }
};

struct ExrHeaders {
    std::vector<ExrPart> parts;
    bool tiled = false;     // the mark of a file with one tiled part
    bool multipart = false; // each part names its own type
    std::uint64_t end = 0;  // where the tables of chunks begin
};

// Bounded access to the bytes of a file, and its errors.
struct ExrBytes {
    std::span<std::uint8_t> bytes;
    const std::string& name;

    [[noreturn]] void fail(const std::string& what) const { throw Error(name, printable(what)); }
    [[noreturn]] void damaged(const std::string& what) const { fail("the EXR file is damaged: " + what); }
    template <typename T>
    T load(std::uint64_t at) const {
        T v;
        if (at > bytes.size() || bytes.size() - at < sizeof v) damaged("it ends too early");
        std::memcpy(&v, bytes.data() + at, sizeof v);
        return v;
    }
};

// Throws Error for what is damaged, deep or subsampled. Attributes that are not needed for the pixels get an
// unknown type in `file.bytes`, so that the library skips unchecked values.
ExrHeaders parse_exr_headers(const ExrBytes& file);

} // namespace montelux
