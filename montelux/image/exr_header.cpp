#include "montelux/image/exr_header.h"

#include <set>
#include <string_view>

namespace montelux {

namespace {

constexpr std::uint32_t tiled_flag = 0x200, long_names_flag = 0x400, deep_flag = 0x800,
                        multipart_flag = 0x1000;
constexpr int max_parts = 256;

class Parser {
  public:
    explicit Parser(const ExrBytes& file) : file_(file) {}

    ExrHeaders parse();

  private:
    template <typename T>
    T load(std::uint64_t at) const {
        return file_.load<T>(at);
    }
    template <typename T>
    T take() {
        T v = load<T>(at_);
        at_ += sizeof v;
        return v;
    }
    std::string take_name(std::size_t limit);
    bool parse_part(ExrPart& part);
    void parse_attribute(ExrPart& part, const std::string& name, const std::string& type, std::uint64_t at,
                         std::uint64_t size);
    void keep_attribute(ExrPart& part, const std::string& name, const std::string& type, std::uint64_t at,
                        std::uint64_t size) const;
    void parse_channels(ExrPart& part, std::uint64_t at, std::uint64_t size) const;
    ExrBox parse_box(const std::string& name, std::uint64_t at) const;

    const ExrBytes& file_;
    std::uint64_t at_ = 0;
    std::size_t name_limit_ = 31;
};

std::string Parser::take_name(std::size_t limit) {
    std::string name;
    while (char c = static_cast<char>(take<std::uint8_t>())) {
        name.push_back(c);
        if (name.size() > limit)
            file_.damaged("a name in the header is longer than " + std::to_string(limit));
    }
    return name;
}

ExrBox Parser::parse_box(const std::string& name, std::uint64_t at) const {
    ExrBox b{load<std::int32_t>(at), load<std::int32_t>(at + 4), load<std::int32_t>(at + 8),
             load<std::int32_t>(at + 12)};
    constexpr std::int64_t far = std::int64_t{1} << 29;
    if (b.max_x < b.min_x || b.max_y < b.min_y || b.min_x < -far || b.min_y < -far || b.max_x > far ||
        b.max_y > far)
        file_.damaged(name + " is (" + std::to_string(b.min_x) + ", " + std::to_string(b.min_y) + ") to (" +
                      std::to_string(b.max_x) + ", " + std::to_string(b.max_y) + ")");
    return b;
}

void Parser::parse_channels(ExrPart& part, std::uint64_t at, std::uint64_t size) const {
    std::uint64_t end = at + size;
    std::set<std::string> seen;
    while (true) {
        std::string name;
        for (;; ++at) {
            if (at >= end) file_.damaged("the channel list has no end");
            if (file_.bytes[at] == 0) break;
            name.push_back(static_cast<char>(file_.bytes[at]));
        }
        ++at;
        if (name.empty()) break;
        if (name.size() > name_limit_)
            file_.damaged("a channel name is longer than " + std::to_string(name_limit_));
        if (at + 16 > end) file_.damaged("the channel list ends inside channel '" + name + "'");
        int type = load<std::int32_t>(at);
        int x_sampling = load<std::int32_t>(at + 8), y_sampling = load<std::int32_t>(at + 12);
        at += 16;
        if (type < 0 || type > 2) file_.damaged("channel '" + name + "' has type " + std::to_string(type));
        if (x_sampling < 1 || y_sampling < 1)
            file_.damaged("channel '" + name + "' has the sampling rate " + std::to_string(x_sampling) +
                          " x " + std::to_string(y_sampling));
        if (x_sampling != 1 || y_sampling != 1)
            file_.fail("channel '" + name + "' is subsampled (" + std::to_string(x_sampling) + " x " +
                       std::to_string(y_sampling) + "); only channels of full resolution can be read");
        if (!seen.insert(name).second) file_.damaged("channel '" + name + "' is named twice");
        part.channels.push_back({name, type});
        part.pixel_bytes += type == 1 ? 2 : 4;
        if (part.channels.size() > Image::max_channels)
            file_.fail("the file has more than " + std::to_string(Image::max_channels) + " channels");
    }
    // OpenEXR ignores the attribute's size and continues at the end mark: it would read what follows as further,
    // unchecked attributes.
    if (at != end)
        file_.damaged("the channel list has " + std::to_string(end - at) + " bytes behind its end");
}

// Values worth keeping; others are left out of the image's attributes.
void Parser::keep_attribute(ExrPart& part, const std::string& name, const std::string& type, std::uint64_t at,
                            std::uint64_t size) const {
    auto floats = [&](std::size_t count) {
        std::vector<float> v;
        for (std::size_t i = 0; i < count; ++i) v.push_back(load<float>(at + 4 * i));
        return v;
    };
    constexpr std::uint64_t max_kept_bytes = 1 << 16;
    if (type == "string" && size <= max_kept_bytes)
        part.attributes[name] = std::string(reinterpret_cast<const char*>(file_.bytes.data() + at), size);
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

void Parser::parse_attribute(ExrPart& part, const std::string& name, const std::string& type,
                             std::uint64_t at, std::uint64_t size) {
    auto expect = [&](std::string_view expected_type, std::uint64_t expected_size) {
        if (type != expected_type || (expected_size != 0 && size != expected_size))
            file_.damaged("attribute '" + name + "' has type '" + type + "' and " + std::to_string(size) +
                          " bytes, but should be '" + std::string(expected_type) + "'");
    };
    if (name == "channels") {
        expect("chlist", 0);
        if (!part.channels.empty()) file_.damaged("there are two channel lists");
        parse_channels(part, at, size);
    } else if (name == "dataWindow") {
        expect("box2i", 16);
        part.data_window = parse_box(name, at);
    } else if (name == "displayWindow") {
        expect("box2i", 16);
        part.display_window = parse_box(name, at);
    } else if (name == "compression") {
        expect("compression", 1);
        part.compression = file_.bytes[at];
    } else if (name == "lineOrder") {
        expect("lineOrder", 1);
        if (file_.bytes[at] > 2)
            file_.damaged("line order " + std::to_string(file_.bytes[at]) + " does not exist");
    } else if (name == "tiles") {
        expect("tiledesc", 9);
        part.tiles = ExrTiles{load<std::uint32_t>(at), load<std::uint32_t>(at + 4), file_.bytes[at + 8] & 15,
                              (file_.bytes[at + 8] >> 4) == 1};
        if ((file_.bytes[at + 8] & 15) > 2 || (file_.bytes[at + 8] >> 4) > 1)
            file_.damaged("the tile description is wrong");
    } else if (name == "chunkCount") {
        expect("int", 4);
        part.chunk_count = load<std::int32_t>(at);
    } else if (name == "type") {
        expect("string", 0);
        part.type = std::string(reinterpret_cast<const char*>(file_.bytes.data() + at), size);
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
        file_.bytes[type_at] = '?';
    }
}

// False at the empty header that ends the list of parts.
bool Parser::parse_part(ExrPart& part) {
    bool any = false;
    while (true) {
        std::string name = take_name(name_limit_);
        if (name.empty()) return any;
        any = true;
        std::string type = take_name(name_limit_);
        if (type.empty()) file_.damaged("attribute '" + name + "' has no type");
        auto size = take<std::int32_t>();
        if (size < 0 || static_cast<std::uint64_t>(size) > file_.bytes.size() - at_)
            file_.damaged("attribute '" + name + "' has " + std::to_string(size) + " bytes");
        parse_attribute(part, name, type, at_, static_cast<std::uint64_t>(size));
        at_ += static_cast<std::uint64_t>(size);
    }
}

ExrHeaders Parser::parse() {
    ExrHeaders headers;
    take<std::uint32_t>();
    auto version = take<std::uint32_t>();
    if ((version & 0xff) != 2) file_.fail("EXR version " + std::to_string(version & 0xff) + " is not known");
    if (version & ~(0xffu | tiled_flag | long_names_flag | deep_flag | multipart_flag))
        file_.damaged("the version field has unknown flags");
    headers.tiled = version & tiled_flag;
    headers.multipart = version & multipart_flag;
    name_limit_ = version & long_names_flag ? 255 : 31;
    if (version & deep_flag) file_.fail("the EXR file holds deep data, which cannot be read");
    if (headers.tiled && headers.multipart)
        file_.damaged("it is marked as both of one tiled part and of several parts");
    while (true) {
        ExrPart part;
        if (!parse_part(part)) break;
        headers.parts.push_back(std::move(part));
        if (!headers.multipart) break;
        if (headers.parts.size() > max_parts)
            file_.fail("the EXR file has more than " + std::to_string(max_parts) + " parts");
    }
    if (headers.parts.empty()) file_.damaged("it has no header");
    headers.end = at_;
    return headers;
}

} // namespace

ExrHeaders parse_exr_headers(const ExrBytes& file) { return Parser(file).parse(); }

} // namespace montelux
