#include "montelux/image/exr_layout.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

constexpr std::uint32_t tiled_flag = 0x200, long_names_flag = 0x400, deep_flag = 0x800,
                        multipart_flag = 0x1000;
constexpr int max_parts = 256;
// Tiles and blocks of scan lines are decompressed whole.
constexpr std::uint64_t max_chunk_bytes = std::uint64_t{256} << 20;

enum Compression { none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab, compression_count };
constexpr std::array<int, compression_count> lines_per_chunk{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

struct Box {
    std::int64_t min_x = 0, min_y = 0, max_x = 0, max_y = 0;
};

struct Tiles {
    std::uint32_t width, height;
    int level_mode; // 0 one level, 1 mipmap, 2 ripmap
    bool round_up;
};

struct Part {
    std::optional<Box> data_window, display_window;
    std::optional<int> compression, chunk_count;
    std::optional<Tiles> tiles;
    std::optional<std::string> type;
    std::vector<ExrChannel> channels;
    std::uint64_t pixel_bytes = 0; // of one pixel, as stored
    Attributes attributes;
    bool tiled = false;

    std::uint64_t width() const {
        return static_cast<std::uint64_t>(data_window->max_x - data_window->min_x + 1);
    }
    std::uint64_t height() const {
        return static_cast<std::uint64_t>(data_window->max_y - data_window->min_y + 1);
    }
};

class Parser {
  public:
    Parser(std::span<std::uint8_t> bytes, const std::string& name, const ReadOptions& options)
        : bytes_(bytes), file_{bytes, name, options} {}

    ExrLayout parse();

  private:
    [[noreturn]] void fail(const std::string& what) const { throw Error(file_.name, printable(what)); }
    [[noreturn]] void damaged(const std::string& what) const { fail("the EXR file is damaged: " + what); }

    template <typename T>
    T load(std::uint64_t at) const {
        T v;
        if (at > bytes_.size() || bytes_.size() - at < sizeof v) damaged("it ends too early");
        std::memcpy(&v, bytes_.data() + at, sizeof v);
        return v;
    }
    template <typename T>
    T take() {
        T v = load<T>(at_);
        at_ += sizeof v;
        return v;
    }
    std::string take_name(std::size_t limit);
    bool parse_part(Part& part);
    void parse_attribute(Part& part, const std::string& name, const std::string& type, std::uint64_t at,
                         std::uint64_t size);
    void keep_attribute(Part& part, const std::string& name, const std::string& type, std::uint64_t at,
                        std::uint64_t size) const;
    void parse_channels(Part& part, std::uint64_t at, std::uint64_t size) const;
    Box parse_box(const std::string& name, std::uint64_t at) const;
    void check_part(Part& part, int index) const;
    std::uint64_t chunk_count(const Part& part, int index) const;
    void check_chunks(const Part& part, int index, std::uint64_t count);

    std::span<std::uint8_t> bytes_;
    EncodedImage file_;
    std::uint64_t at_ = 0;
    bool tiled_ = false, multipart_ = false;
    std::size_t name_limit_ = 31;
};

std::string Parser::take_name(std::size_t limit) {
    std::string name;
    while (char c = static_cast<char>(take<std::uint8_t>())) {
        name.push_back(c);
        if (name.size() > limit) damaged("a name in the header is longer than " + std::to_string(limit));
    }
    return name;
}

Box Parser::parse_box(const std::string& name, std::uint64_t at) const {
    Box b{load<std::int32_t>(at), load<std::int32_t>(at + 4), load<std::int32_t>(at + 8),
          load<std::int32_t>(at + 12)};
    constexpr std::int64_t far = std::int64_t{1} << 29;
    if (b.max_x < b.min_x || b.max_y < b.min_y || b.min_x < -far || b.min_y < -far || b.max_x > far ||
        b.max_y > far)
        damaged(name + " is (" + std::to_string(b.min_x) + ", " + std::to_string(b.min_y) + ") to (" +
                std::to_string(b.max_x) + ", " + std::to_string(b.max_y) + ")");
    return b;
}

void Parser::parse_channels(Part& part, std::uint64_t at, std::uint64_t size) const {
    std::uint64_t end = at + size;
    std::set<std::string> seen;
    while (true) {
        std::string name;
        for (;; ++at) {
            if (at >= end) damaged("the channel list has no end");
            if (bytes_[at] == 0) break;
            name.push_back(static_cast<char>(bytes_[at]));
        }
        ++at;
        if (name.empty()) break;
        if (name.size() > name_limit_)
            damaged("a channel name is longer than " + std::to_string(name_limit_));
        if (at + 16 > end) damaged("the channel list ends inside channel '" + name + "'");
        int type = load<std::int32_t>(at);
        int x_sampling = load<std::int32_t>(at + 8), y_sampling = load<std::int32_t>(at + 12);
        at += 16;
        if (type < 0 || type > 2) damaged("channel '" + name + "' has type " + std::to_string(type));
        if (x_sampling < 1 || y_sampling < 1)
            damaged("channel '" + name + "' has the sampling rate " + std::to_string(x_sampling) + " x " +
                    std::to_string(y_sampling));
        if (x_sampling != 1 || y_sampling != 1)
            fail("channel '" + name + "' is subsampled (" + std::to_string(x_sampling) + " x " +
                 std::to_string(y_sampling) + "); only channels of full resolution can be read");
        if (!seen.insert(name).second) damaged("channel '" + name + "' is named twice");
        part.channels.push_back({name, type});
        part.pixel_bytes += type == 1 ? 2 : 4;
        if (part.channels.size() > Image::max_channels)
            fail("the file has more than " + std::to_string(Image::max_channels) + " channels");
    }
}

// Values worth keeping; others are left out of the image's attributes.
void Parser::keep_attribute(Part& part, const std::string& name, const std::string& type, std::uint64_t at,
                            std::uint64_t size) const {
    auto floats = [&](std::size_t count) {
        std::vector<float> v;
        for (std::size_t i = 0; i < count; ++i) v.push_back(load<float>(at + 4 * i));
        return v;
    };
    constexpr std::uint64_t max_kept_bytes = 1 << 16;
    if (type == "string" && size <= max_kept_bytes)
        part.attributes[name] = std::string(reinterpret_cast<const char*>(bytes_.data() + at), size);
    else if (type == "int" && size == 4)
        part.attributes[name] = load<std::int32_t>(at);
    else if (type == "float" && size == 4)
        part.attributes[name] = load<float>(at);
    else if (type == "double" && size == 8)
        part.attributes[name] = load<double>(at);
    else if ((type == "v2f" && size == 8) || (type == "v3f" && size == 12) ||
             (type == "chromaticities" && size == 32))
        part.attributes[name] = floats(size / 4);
    else if (type == "floatvector" && size % 4 == 0 && size <= max_kept_bytes)
        part.attributes[name] = floats(size / 4);
    else if (type == "m44f" && size == 64) {
        Matrix4 m;
        for (int i = 0; i < 16; ++i) m.m[i % 4][i / 4] = static_cast<double>(load<float>(at + 4 * i));
        part.attributes[name] = m;
    }
}

void Parser::parse_attribute(Part& part, const std::string& name, const std::string& type, std::uint64_t at,
                             std::uint64_t size) {
    auto expect = [&](std::string_view expected_type, std::uint64_t expected_size) {
        if (type != expected_type || (expected_size != 0 && size != expected_size))
            damaged("attribute '" + name + "' has type '" + type + "' and " + std::to_string(size) +
                    " bytes, but should be '" + std::string(expected_type) + "'");
    };
    if (name == "channels") {
        expect("chlist", 0);
        if (!part.channels.empty()) damaged("there are two channel lists");
        parse_channels(part, at, size);
    } else if (name == "dataWindow") {
        expect("box2i", 16);
        part.data_window = parse_box(name, at);
    } else if (name == "displayWindow") {
        expect("box2i", 16);
        part.display_window = parse_box(name, at);
    } else if (name == "compression") {
        expect("compression", 1);
        part.compression = bytes_[at];
    } else if (name == "lineOrder") {
        expect("lineOrder", 1);
        if (bytes_[at] > 2) damaged("line order " + std::to_string(bytes_[at]) + " does not exist");
    } else if (name == "tiles") {
        expect("tiledesc", 9);
        part.tiles = Tiles{load<std::uint32_t>(at), load<std::uint32_t>(at + 4), bytes_[at + 8] & 15,
                           (bytes_[at + 8] >> 4) == 1};
        if ((bytes_[at + 8] & 15) > 2 || (bytes_[at + 8] >> 4) > 1) damaged("the tile description is wrong");
    } else if (name == "chunkCount") {
        expect("int", 4);
        part.chunk_count = load<std::int32_t>(at);
    } else if (name == "type") {
        expect("string", 0);
        part.type = std::string(reinterpret_cast<const char*>(bytes_.data() + at), size);
    } else if (name == "name" || name == "view") {
        expect("string", 0);
        keep_attribute(part, name, type, at, size);
    } else if (name == "version") {
        expect("int", 4);
    } else if (name == "pixelAspectRatio" || name == "screenWindowWidth") {
        expect("float", 4);
        keep_attribute(part, name, type, at, size);
    } else if (name == "screenWindowCenter") {
        expect("v2f", 8);
        keep_attribute(part, name, type, at, size);
    } else {
        keep_attribute(part, name, type, at, size);
        // The byte before the size's four is the end of the type's name.
        std::uint64_t type_at = at - 5 - type.size();
        bytes_[type_at] = '?';
    }
}

// False at the empty header that ends the list of parts.
bool Parser::parse_part(Part& part) {
    bool any = false;
    while (true) {
        std::string name = take_name(name_limit_);
        if (name.empty()) return any;
        any = true;
        std::string type = take_name(name_limit_);
        if (type.empty()) damaged("attribute '" + name + "' has no type");
        auto size = take<std::int32_t>();
        if (size < 0 || static_cast<std::uint64_t>(size) > bytes_.size() - at_)
            damaged("attribute '" + name + "' has " + std::to_string(size) + " bytes");
        parse_attribute(part, name, type, at_, static_cast<std::uint64_t>(size));
        at_ += static_cast<std::uint64_t>(size);
    }
}

void Parser::check_part(Part& part, int index) const {
    if (!part.data_window) damaged("the header has no dataWindow");
    if (!part.display_window) damaged("the header has no displayWindow");
    if (!part.compression) damaged("the header has no compression");
    if (part.channels.empty()) damaged("the header has no channels");
    if (*part.compression >= compression_count)
        damaged("compression method " + std::to_string(*part.compression) + " is not known");
    if (multipart_) {
        if (!part.type) damaged("part " + std::to_string(index) + " has no type");
        if (*part.type == "deepscanline" || *part.type == "deeptile")
            fail("the EXR file holds deep data, which cannot be read");
        if (*part.type != "scanlineimage" && *part.type != "tiledimage")
            damaged("part " + std::to_string(index) + " has the type '" + *part.type + "'");
        part.tiled = *part.type == "tiledimage";
    } else {
        part.tiled = tiled_;
    }
    check_image_size(file_, part.width(), part.height(), part.channels.size(), 1);
    if (part.tiled) {
        if (!part.tiles) damaged("the header of a tiled picture has no tiles");
        const Tiles& t = *part.tiles;
        if (t.width < 1 || t.height < 1 || t.width > Image::max_dimension ||
            t.height > Image::max_dimension ||
            std::uint64_t{t.width} * t.height * part.pixel_bytes > max_chunk_bytes)
            fail("the tiles of the EXR file are " + std::to_string(t.width) + " x " +
                 std::to_string(t.height) + " pixels, which is not allowed");
    } else {
        std::uint64_t lines = static_cast<std::uint64_t>(lines_per_chunk[*part.compression]);
        if (part.width() * lines * part.pixel_bytes > max_chunk_bytes)
            fail("one block of scan lines of the EXR file needs more than " +
                 std::to_string(max_chunk_bytes >> 20) + " MiB");
    }
}

std::uint64_t Parser::chunk_count(const Part& part, int index) const {
    auto divide_up = [](std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; };
    std::uint64_t count = 0;
    if (!part.tiled) {
        count = divide_up(part.height(), static_cast<std::uint64_t>(lines_per_chunk[*part.compression]));
    } else {
        const Tiles& t = *part.tiles;
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
    if (multipart_ && !part.chunk_count) damaged("part " + std::to_string(index) + " has no chunkCount");
    if (part.chunk_count && static_cast<std::uint64_t>(std::max(*part.chunk_count, 0)) != count)
        damaged("chunkCount is " + std::to_string(*part.chunk_count) + ", but the picture has " +
                std::to_string(count) + " chunks");
    // Each chunk has an entry of 8 bytes and a frame of at least 8.
    if (count > bytes_.size() / 16)
        damaged("the header promises " + std::to_string(count) + " chunks, more than the file can hold");
    return count;
}

void Parser::check_chunks(const Part& part, int index, std::uint64_t count) {
    std::uint64_t table = at_;
    if (count * 8 > bytes_.size() - at_) damaged("it ends inside the table of chunks");
    at_ += count * 8;
    std::uint64_t frame = (multipart_ ? 4u : 0u) + (part.tiled ? 20u : 8u);
    // The tightest packing of each method: deflate 1032 to 1 (after 4 bytes became 3 in PXR24), run lengths
    // 128 bytes into 2; the others have no bound worth a check.
    int method = *part.compression;
    bool deflated = method == zips || method == zip || method == pxr24;
    std::uint64_t best_ratio = method == none ? 1 : method == rle ? 64 : deflated ? 1400 : 1 << 20;
    std::uint64_t packed_total = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        auto offset = load<std::uint64_t>(table + 8 * i);
        if (offset == 0) fail("the EXR file is incomplete: chunk " + std::to_string(i) + " is missing");
        if (offset < table || offset > bytes_.size() || bytes_.size() - offset < frame)
            damaged("chunk " + std::to_string(i) + " lies outside the file");
        if (index != 0) continue;
        if (multipart_ && load<std::int32_t>(offset) != 0)
            damaged("chunk " + std::to_string(i) + " belongs to another part");
        auto packed = load<std::int32_t>(offset + frame - 4);
        if (packed < 0 || static_cast<std::uint64_t>(packed) > bytes_.size() - offset - frame)
            damaged("chunk " + std::to_string(i) + " has " + std::to_string(packed) + " bytes");
        if (!part.tiled) {
            std::int64_t y = load<std::int32_t>(offset + frame - 8);
            std::int64_t expected =
                part.data_window->min_y + static_cast<std::int64_t>(i) * lines_per_chunk[method];
            if (y != expected)
                damaged("chunk " + std::to_string(i) + " begins at line " + std::to_string(y) +
                        " instead of " + std::to_string(expected));
        }
        packed_total += static_cast<std::uint64_t>(packed);
    }
    if (index == 0 && packed_total * best_ratio < part.width() * part.height() * part.pixel_bytes)
        damaged("its chunks are too short for " + std::to_string(part.width()) + " x " +
                std::to_string(part.height()) + " pixels");
}

ExrLayout Parser::parse() {
    take<std::uint32_t>();
    auto version = take<std::uint32_t>();
    if ((version & 0xff) != 2) fail("EXR version " + std::to_string(version & 0xff) + " is not known");
    if (version & ~(0xffu | tiled_flag | long_names_flag | deep_flag | multipart_flag))
        damaged("the version field has unknown flags");
    tiled_ = version & tiled_flag;
    multipart_ = version & multipart_flag;
    name_limit_ = version & long_names_flag ? 255 : 31;
    if (version & deep_flag) fail("the EXR file holds deep data, which cannot be read");
    if (tiled_ && multipart_) damaged("it is marked as both of one tiled part and of several parts");

    std::vector<Part> parts;
    while (true) {
        Part part;
        if (!parse_part(part)) break;
        parts.push_back(std::move(part));
        if (!multipart_) break;
        if (parts.size() > max_parts)
            fail("the EXR file has more than " + std::to_string(max_parts) + " parts");
    }
    if (parts.empty()) damaged("it has no header");
    std::vector<std::uint64_t> counts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        check_part(parts[i], static_cast<int>(i));
        counts.push_back(chunk_count(parts[i], static_cast<int>(i)));
    }
    for (std::size_t i = 0; i < parts.size(); ++i) check_chunks(parts[i], static_cast<int>(i), counts[i]);

    Part& first = parts.front();
    ExrLayout layout;
    layout.min_x = static_cast<int>(first.data_window->min_x);
    layout.min_y = static_cast<int>(first.data_window->min_y);
    layout.width = static_cast<int>(first.width());
    layout.height = static_cast<int>(first.height());
    layout.channels = std::move(first.channels);
    layout.attributes = std::move(first.attributes);
    return layout;
}

} // namespace

ExrLayout parse_exr(std::span<std::uint8_t> bytes, const std::string& name, const ReadOptions& options) {
    return Parser(bytes, name, options).parse();
}

} // namespace montelux
