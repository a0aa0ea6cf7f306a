#include "montelux/image/exr_layout.h"

#include <algorithm>
#include <array>

namespace montelux {

namespace {

// Tiles and blocks of scan lines are decompressed whole.
constexpr std::uint64_t max_chunk_bytes = std::uint64_t{256} << 20;

enum Compression { none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab, compression_count };
constexpr std::array<int, compression_count> lines_per_chunk{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

// Checks the headers against the bytes that follow them.
class Checker {
  public:
    Checker(const ExrBytes& file, const ReadOptions& options, const ExrHeaders& headers)
        : file_(file), encoded_{file.bytes, file.name, options}, headers_(headers), at_(headers.end) {}

    void check();

  private:
    bool is_tiled(const ExrPart& part) const {
        return headers_.multipart ? part.type == "tiledimage" : headers_.tiled;
    }
    void check_part(const ExrPart& part, int index) const;
    std::uint64_t chunk_count(const ExrPart& part, int index) const;
    void check_chunks(const ExrPart& part, int index, std::uint64_t count);

    const ExrBytes& file_;
    EncodedImage encoded_;
    const ExrHeaders& headers_;
    std::uint64_t at_;
};

void Checker::check_part(const ExrPart& part, int index) const {
    if (!part.data_window) file_.damaged("the header has no dataWindow");
    if (!part.display_window) file_.damaged("the header has no displayWindow");
    if (!part.compression) file_.damaged("the header has no compression");
    if (part.channels.empty()) file_.damaged("the header has no channels");
    if (*part.compression >= compression_count)
        file_.damaged("compression method " + std::to_string(*part.compression) + " is not known");
    if (headers_.multipart) {
        if (!part.type) file_.damaged("part " + std::to_string(index) + " has no type");
        if (*part.type == "deepscanline" || *part.type == "deeptile")
            file_.fail("the EXR file holds deep data, which cannot be read");
        if (*part.type != "scanlineimage" && *part.type != "tiledimage")
            file_.damaged("part " + std::to_string(index) + " has the type '" + *part.type + "'");
    }
    check_image_size(encoded_, part.width(), part.height(), part.channels.size(), 1);
    if (is_tiled(part)) {
        if (!part.tiles) file_.damaged("the header of a tiled picture has no tiles");
        const ExrTiles& t = *part.tiles;
        if (t.width < 1 || t.height < 1 || t.width > Image::max_dimension ||
            t.height > Image::max_dimension ||
            std::uint64_t{t.width} * t.height * part.pixel_bytes > max_chunk_bytes)
            file_.fail("the tiles of the EXR file are " + std::to_string(t.width) + " x " +
                       std::to_string(t.height) + " pixels, which is not allowed");
    } else {
        std::uint64_t lines = static_cast<std::uint64_t>(lines_per_chunk[*part.compression]);
        if (part.width() * lines * part.pixel_bytes > max_chunk_bytes)
            file_.fail("one block of scan lines of the EXR file needs more than " +
                       std::to_string(max_chunk_bytes >> 20) + " MiB");
    }
}

std::uint64_t Checker::chunk_count(const ExrPart& part, int index) const {
    auto divide_up = [](std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; };
    std::uint64_t count = 0;
    if (!is_tiled(part)) {
        count = divide_up(part.height(), static_cast<std::uint64_t>(lines_per_chunk[*part.compression]));
    } else {
        const ExrTiles& t = *part.tiles;
        auto level_size = [&](std::uint64_t size, int level) {
            std::uint64_t scaled = t.round_up ? divide_up(size, std::uint64_t{1} << level) : size >> level;
            return std::max<std::uint64_t>(scaled, 1);
        };
        auto level_count = [&](std::uint64_t size) {
            int levels = 1;
            for (std::uint64_t s = size; s > 1; s = t.round_up ? divide_up(s, 2) : s / 2) ++levels;
            return levels;
        };
        auto tiles_x = [&](int level) { return divide_up(level_size(part.width(), level), t.width); };
        auto tiles_y = [&](int level) { return divide_up(level_size(part.height(), level), t.height); };
        if (t.level_mode == 0) {
            count = tiles_x(0) * tiles_y(0);
        } else if (t.level_mode == 1) {
            int levels = level_count(std::max(part.width(), part.height()));
            for (int l = 0; l < levels; ++l) count += tiles_x(l) * tiles_y(l);
        } else {
            for (int ly = 0; ly < level_count(part.height()); ++ly)
                for (int lx = 0; lx < level_count(part.width()); ++lx) count += tiles_x(lx) * tiles_y(ly);
        }
    }
    if (headers_.multipart && !part.chunk_count)
        file_.damaged("part " + std::to_string(index) + " has no chunkCount");
    if (part.chunk_count && static_cast<std::uint64_t>(std::max(*part.chunk_count, 0)) != count)
        file_.damaged("chunkCount is " + std::to_string(*part.chunk_count) + ", but the picture has " +
                      std::to_string(count) + " chunks");
    // Each chunk has an entry of 8 bytes and a frame of at least 8.
    if (count > file_.bytes.size() / 16)
        file_.damaged("the header promises " + std::to_string(count) +
                      " chunks, more than the file can hold");
    return count;
}

void Checker::check_chunks(const ExrPart& part, int index, std::uint64_t count) {
    std::uint64_t table = at_;
    if (count * 8 > file_.bytes.size() - at_) file_.damaged("it ends inside the table of chunks");
    at_ += count * 8;
    std::uint64_t frame = (headers_.multipart ? 4u : 0u) + (is_tiled(part) ? 20u : 8u);
    // The tightest packing of each method: deflate 1032 to 1 (after 4 bytes became 3 in PXR24), run lengths
    // 128 bytes into 2; the others have no useful bound.
    int method = *part.compression;
    bool deflated = method == zips || method == zip || method == pxr24;
    std::uint64_t best_ratio = method == none ? 1 : method == rle ? 64 : deflated ? 1400 : 1 << 20;
    std::uint64_t packed_total = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        auto offset = file_.load<std::uint64_t>(table + 8 * i);
        if (offset == 0) file_.fail("the EXR file is incomplete: chunk " + std::to_string(i) + " is missing");
        if (offset < table || offset > file_.bytes.size() || file_.bytes.size() - offset < frame)
            file_.damaged("chunk " + std::to_string(i) + " lies outside the file");
        if (index != 0) continue;
        if (headers_.multipart && file_.load<std::int32_t>(offset) != 0)
            file_.damaged("chunk " + std::to_string(i) + " belongs to another part");
        auto packed = file_.load<std::int32_t>(offset + frame - 4);
        if (packed < 0 || static_cast<std::uint64_t>(packed) > file_.bytes.size() - offset - frame)
            file_.damaged("chunk " + std::to_string(i) + " has " + std::to_string(packed) + " bytes");
        if (!is_tiled(part)) {
            std::int64_t y = file_.load<std::int32_t>(offset + frame - 8);
            std::int64_t expected =
                part.data_window->min_y + static_cast<std::int64_t>(i) * lines_per_chunk[method];
            if (y != expected)
                file_.damaged("chunk " + std::to_string(i) + " begins at line " + std::to_string(y) +
                              " instead of " + std::to_string(expected));
        }
        packed_total += static_cast<std::uint64_t>(packed);
    }
    if (index == 0 && packed_total * best_ratio < part.width() * part.height() * part.pixel_bytes)
        file_.damaged("its chunks are too short for " + std::to_string(part.width()) + " x " +
                      std::to_string(part.height()) + " pixels");
}

void Checker::check() {
    const auto& parts = headers_.parts;
    std::vector<std::uint64_t> counts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        check_part(parts[i], static_cast<int>(i));
        counts.push_back(chunk_count(parts[i], static_cast<int>(i)));
    }
    for (std::size_t i = 0; i < parts.size(); ++i) check_chunks(parts[i], static_cast<int>(i), counts[i]);
}

} // namespace

ExrLayout parse_exr(std::span<std::uint8_t> bytes, const std::string& name, const ReadOptions& options) {
    ExrBytes file{bytes, name};
    ExrHeaders headers = parse_exr_headers(file);
    Checker(file, options, headers).check();
    ExrPart& first = headers.parts.front();
    ExrLayout layout;
    layout.min_x = static_cast<int>(first.data_window->min_x);
    layout.min_y = static_cast<int>(first.data_window->min_y);
    layout.width = static_cast<int>(first.width());
    layout.height = static_cast<int>(first.height());
    const ExrBox& display = *first.display_window;
    layout.display = {static_cast<int>(display.min_x), static_cast<int>(display.min_y),
                      static_cast<int>(display.max_x + 1), static_cast<int>(display.max_y + 1)};
    layout.channels = std::move(first.channels);
    layout.attributes = std::move(first.attributes);
    return layout;
}

} // namespace montelux
