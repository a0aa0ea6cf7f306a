// The header of a PLY file: which elements with which properties follow.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::ply {

enum class Format : std::uint8_t { ascii, little_endian, big_endian };
enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(Type type);
bool is_integer(Type type);

struct Property {
    std::string name;
    Type type = Type::float32;
    bool is_list = false;
    Type count_type = Type::uint8; // of a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
    std::size_t line = 0; // of the header, from 1
};

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
    std::size_t size = 0;  // bytes up to the data
    std::size_t lines = 0; // of the header
};

// Throws Error with `name` and the line in front. The counts are what the file says.
Header parse_header(std::span<const std::uint8_t> bytes, std::string_view name);

} // namespace montelux::ply
