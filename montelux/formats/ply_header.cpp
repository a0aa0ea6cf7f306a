#include "montelux/formats/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux::ply {
namespace {

constexpr std::size_t max_header_bytes = 1 << 20;
constexpr std::size_t max_properties = 1000;

std::optional<Type> parse_type(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, Type>, 16> names = {{{"char", Type::int8},
                                                                          {"int8", Type::int8},
                                                                          {"uchar", Type::uint8},
                                                                          {"uint8", Type::uint8},
                                                                          {"short", Type::int16},
                                                                          {"int16", Type::int16},
                                                                          {"ushort", Type::uint16},
                                                                          {"uint16", Type::uint16},
                                                                          {"int", Type::int32},
                                                                          {"int32", Type::int32},
                                                                          {"uint", Type::uint32},
                                                                          {"uint32", Type::uint32},
                                                                          {"float", Type::float32},
                                                                          {"float32", Type::float32},
                                                                          {"double", Type::float64},
                                                                          {"float64", Type::float64}}};
    for (auto [text, type] : names)
        if (text == name) return type;
    return std::nullopt;
}

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> words;
    constexpr std::string_view blank = " \t";
    for (std::size_t i = line.find_first_not_of(blank); i != std::string_view::npos;) {
        std::size_t end = std::min(line.find_first_of(blank, i), line.size());
        words.push_back(line.substr(i, end - i));
        i = line.find_first_not_of(blank, end);
    }
    return words;
}

class HeaderParser {
  public:
    HeaderParser(std::string_view text, std::string_view name) : text_(text), name_(name) {}

    Header parse() {
        if (next_line() != "ply") fail("expected 'ply' on the first line: this is not a PLY file");
        bool have_format = false;
        for (;;) {
            std::vector<std::string_view> words = split(next_line());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") break;
            if (words[0] == "format") {
                parse_format(words);
                have_format = true;
            } else if (words[0] == "element") {
                parse_element(words);
            } else if (words[0] == "property") {
                parse_property(words);
            } else {
                fail("unknown header line that begins with '" + shortened(words[0]) + "'");
            }
        }
        if (!have_format) fail("the header has no line 'format'");
        header_.size = position_;
        header_.lines = line_;
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(std::string_view what) const {
        throw Error(std::string(name_) + ":" + std::to_string(line_), what);
    }
    static std::string shortened(std::string_view word) {
        std::string s(word.substr(0, 40));
        std::replace_if(
            s.begin(), s.end(), [](char c) { return c < 0x20 || c == 0x7f; }, '?');
        return s;
    }

    // Lines end with LF or CR LF.
    std::string_view next_line() {
        ++line_;
        std::size_t end = text_.substr(0, std::min(text_.size(), max_header_bytes)).find('\n', position_);
        if (end == std::string_view::npos) fail("the header has no end; expected 'end_header'");
        std::string_view line = text_.substr(position_, end - position_);
        position_ = end + 1;
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    void parse_format(const std::vector<std::string_view>& words) {
        if (words.size() != 3) fail("expected 'format', a format and a version");
        if (words[1] == "ascii")
            header_.format = Format::ascii;
        else if (words[1] == "binary_little_endian")
            header_.format = Format::little_endian;
        else if (words[1] == "binary_big_endian")
            header_.format = Format::big_endian;
        else
            fail("format '" + shortened(words[1]) +
                 "'; expected ascii, binary_little_endian or binary_big_endian");
        if (words[2] != "1.0") fail("version '" + shortened(words[2]) + "'; expected 1.0");
    }

    void parse_element(const std::vector<std::string_view>& words) {
        Element e;
        if (words.size() != 3) fail("expected 'element', a name and a count");
        e.name = words[1];
        e.line = line_;
        const char* end = words[2].data() + words[2].size();
        auto [stop, error] = std::from_chars(words[2].data(), end, e.count);
        if (error != std::errc() || stop != end)
            fail("element '" + shortened(words[1]) + "' has the count '" + shortened(words[2]) +
                 "'; expected a number of 0 or more");
        for (const Element& other : header_.elements)
            if (other.name == e.name) fail("element '" + shortened(e.name) + "' is declared twice");
        if (header_.elements.size() >= max_properties) fail("too many elements");
        header_.elements.push_back(std::move(e));
    }

    void parse_property(const std::vector<std::string_view>& words) {
        if (header_.elements.empty()) fail("a property before the first element");
        Element& e = header_.elements.back();
        Property p;
        p.is_list = words.size() > 1 && words[1] == "list";
        if (words.size() != (p.is_list ? 5u : 3u))
            fail("expected 'property', a type and a name, or 'property list', two types and a name");
        p.type = type(words[p.is_list ? 3 : 1]);
        if (p.is_list) p.count_type = type(words[2]);
        if (p.is_list && !is_integer(p.count_type)) fail("the count of a list must be of an integer type");
        p.name = words.back();
        for (const Property& other : e.properties)
            if (other.name == p.name) fail("property '" + shortened(p.name) + "' is declared twice");
        if (e.properties.size() >= max_properties) fail("too many properties");
        e.properties.push_back(std::move(p));
    }

    Type type(std::string_view name) const {
        std::optional<Type> t = parse_type(name);
        if (!t) fail("unknown property type '" + shortened(name) + "'");
        return *t;
    }

    std::string_view text_, name_;
    std::size_t position_ = 0, line_ = 0;
    Header header_;
};

} // namespace

std::size_t size_of(Type type) {
    constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

bool is_integer(Type type) { return type != Type::float32 && type != Type::float64; }

Header parse_header(std::span<const std::uint8_t> bytes, std::string_view name) {
    return HeaderParser({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name).parse();
}

} // namespace montelux::ply
