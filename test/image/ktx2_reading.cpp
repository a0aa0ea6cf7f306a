#include "test/image/ktx2_reading.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>

namespace montelux {

namespace {

void rule(bool holds, const std::string& what) {
    if (!holds) throw std::runtime_error(what);
}

template <typename T>
T number(const std::string& bytes, std::size_t at) {
    rule(at + sizeof(T) <= bytes.size(), "the file ends too early");
    T value = 0;
    for (std::size_t i = sizeof(T); i-- > 0;)
        value = static_cast<T>(value << 8 | static_cast<unsigned char>(bytes[at + i]));
    return value;
}
std::uint32_t u32(const std::string& bytes, std::size_t at) { return number<std::uint32_t>(bytes, at); }

struct Known {
    std::uint32_t format, type_size, texel_bytes, channels;
};
// Vulkan 1.3, "Format Definition": numbers of VkFormat.
constexpr Known known[] = {{37, 1, 4, 4},   {83, 2, 4, 2},  {97, 2, 8, 4}, {103, 4, 8, 2},
                           {109, 4, 16, 4}, {122, 4, 4, 3}, {123, 4, 4, 3}};

Known known_format(std::uint32_t format) {
    for (const Known& k : known)
        if (k.format == format) return k;
    throw std::runtime_error("unknown format " + std::to_string(format));
}

void check_descriptor(Ktx2Contents& file, const Known& format) {
    const auto& d = file.descriptor;
    rule(d.size() >= 7, "the descriptor has no block");
    rule(d[1] == 0, "the descriptor block is not Khronos' basic one");
    rule((d[2] & 0xffff) == 2, "the descriptor's version is not 2");
    rule(d[2] >> 16 == 4 * (d.size() - 1), "the descriptor's block size is wrong");
    rule((d[3] & 0xff) == 1, "the colour model is not RGBSDA");
    file.color_primaries = d[3] >> 8 & 0xff;
    rule(file.color_primaries <= 1, "the primaries are neither unspecified nor BT.709");
    rule((d[3] >> 16 & 0xff) == 1, "the transfer function is not linear");
    rule(d[3] >> 24 == 0, "there are flags");
    rule(d[4] == 0, "a block is not one texel");
    rule(d[5] == format.texel_bytes && d[6] == 0, "there is not one plane of the texel's bytes");
    rule((d.size() - 7) % 4 == 0, "the samples are cut");
    // Every bit of the texel is said to be something; a shared exponent is said three times.
    std::vector<int> seen(format.texel_bytes * 8);
    std::vector<std::uint32_t> channels;
    for (std::size_t at = 7; at < d.size(); at += 4) {
        const std::uint32_t offset = d[at] & 0xffff, bits = (d[at] >> 16 & 0xff) + 1;
        const std::uint32_t channel = d[at] >> 24 & 0xf, qualifiers = d[at] >> 24 & 0xf0;
        rule(offset + bits <= seen.size(), "a sample reaches beyond the texel");
        const bool exponent = qualifiers == 0x20;
        for (std::uint32_t i = offset; i < offset + bits; ++i) {
            rule(seen[i] == 0 || exponent, "samples overlap");
            ++seen[i];
        }
        rule(d[at + 1] == 0, "a sample has a position");
        if (!exponent) channels.push_back(channel);
        if (qualifiers == 0xc0) // signed and float
            rule(d[at + 2] == 0xbf800000 && d[at + 3] == 0x3f800000,
                 "a signed float is not bounded by -1, 1");
        else if (qualifiers == 0x80)
            rule(d[at + 2] == 0 && d[at + 3] == 0x3f800000, "an unsigned float is not bounded by 0, 1");
        else if (exponent)
            rule(d[at + 2] == 15 && d[at + 3] == 31, "the exponent's bias or maximum is wrong");
        else if (format.format == 123)
            rule(d[at + 2] == 0 && d[at + 3] == 8448, "the mantissa's bounds are wrong");
        else
            rule(qualifiers == 0 && d[at + 2] == 0 && d[at + 3] == (1u << bits) - 1, "bounds of an integer");
        const bool is_float = format.format != 37 && format.format != 123;
        rule(is_float == ((qualifiers & 0x80) != 0), "integers and floats are mistaken");
    }
    rule(std::all_of(seen.begin(), seen.end(), [](int n) { return n > 0; }), "bits without a meaning");
    std::vector<std::uint32_t> expected{0, 1, 2, 15};
    expected.resize(format.channels);
    rule(channels == expected, "the channels are wrong or in another order");
}

void read_notes(Ktx2Contents& file, const std::string& bytes, std::size_t at, std::size_t size) {
    const std::size_t end = at + size;
    std::string last;
    while (at < end) {
        const std::uint32_t length = u32(bytes, at);
        rule(length >= 2 && at + 4 + length <= end, "a key/value pair reaches beyond its data");
        const std::string pair = bytes.substr(at + 4, length);
        const std::size_t zero = pair.find('\0');
        rule(zero != std::string::npos && zero > 0, "a key is empty or has no end");
        const std::string key = pair.substr(0, zero), value = pair.substr(zero + 1);
        rule(last < key, "the keys are not sorted");
        rule(!value.empty() && value.back() == '\0', "a text does not end with 0");
        file.notes[key] = value.substr(0, value.size() - 1);
        last = key;
        at += 4 + length;
        for (; at % 4 != 0; ++at) rule(at < end && bytes[at] == 0, "padding of a key/value pair");
    }
    rule(at == end, "the key/value data has another length");
}

} // namespace

Ktx2Contents read_ktx2(const std::string& bytes) {
    rule(bytes.substr(0, 12) == std::string("\xABKTX 20\xBB\r\n\x1A\n"), "the identifier is wrong");
    Ktx2Contents file;
    file.format = u32(bytes, 12);
    file.type_size = u32(bytes, 16);
    file.width = u32(bytes, 20);
    file.height = u32(bytes, 24);
    file.faces = u32(bytes, 36);
    const std::uint32_t levels = u32(bytes, 40);
    const Known format = known_format(file.format);
    rule(file.type_size == format.type_size, "the type size is wrong");
    rule(file.width > 0 && file.height > 0, "a side is 0");
    rule(u32(bytes, 28) == 0 && u32(bytes, 32) == 0, "it is a volume or an array");
    rule(file.faces == 1 || (file.faces == 6 && file.width == file.height), "wrong faces");
    rule(levels >= 1 && levels <= 32, "no level, or too many");
    rule((std::max(file.width, file.height) >> (levels - 1)) > 0, "more levels than the size allows");
    rule(u32(bytes, 44) == 0, "it is supercompressed");

    const std::uint32_t descriptor_at = u32(bytes, 48), descriptor_bytes = u32(bytes, 52);
    const std::uint32_t notes_at = u32(bytes, 56), notes_bytes = u32(bytes, 60);
    rule(number<std::uint64_t>(bytes, 64) == 0 && number<std::uint64_t>(bytes, 72) == 0, "global data");
    rule(descriptor_at == 80 + 24 * levels, "the descriptor does not follow the level index");
    rule(u32(bytes, descriptor_at) == descriptor_bytes, "the descriptor's two lengths differ");
    rule(descriptor_bytes % 4 == 0, "the descriptor is not whole words");
    rule(descriptor_at + descriptor_bytes == notes_at, "key/value data does not follow the descriptor");
    for (std::uint32_t i = 0; i < descriptor_bytes; i += 4)
        file.descriptor.push_back(u32(bytes, descriptor_at + i));
    check_descriptor(file, format);
    read_notes(file, bytes, notes_at, notes_bytes);

    const std::uint64_t alignment = std::lcm(format.texel_bytes, 4u);
    std::uint64_t end = notes_at + notes_bytes;
    for (std::uint32_t level = levels; level-- > 0;) {
        const std::size_t entry = 80 + 24 * level;
        const auto offset = number<std::uint64_t>(bytes, entry),
                   length = number<std::uint64_t>(bytes, entry + 8);
        rule(number<std::uint64_t>(bytes, entry + 16) == length, "the uncompressed length differs");
        const std::uint64_t w = std::max(1u, file.width >> level), h = std::max(1u, file.height >> level);
        rule(length == w * h * file.faces * format.texel_bytes, "a level has another length than its texels");
        rule(offset % alignment == 0, "a level is not aligned");
        rule(offset >= end && offset - end < alignment,
             "levels overlap, have gaps, or the largest is not last");
        rule(offset + length <= bytes.size(), "a level reaches beyond the file");
        for (std::uint64_t i = end; i < offset; ++i) rule(bytes[i] == 0, "padding before a level is not 0");
        file.levels.insert(file.levels.begin(), bytes.substr(offset, length));
        end = offset + length;
    }
    rule(end == bytes.size(), "bytes follow the last level");
    return file;
}

double decode_small_float(std::uint32_t bits, int mantissa) {
    const int exponent = static_cast<int>(bits >> mantissa);
    const double fraction = std::ldexp(static_cast<double>(bits & ((1u << mantissa) - 1)), -mantissa);
    if (exponent == 31) return fraction == 0 ? HUGE_VAL : std::nan("");
    return exponent == 0 ? std::ldexp(fraction, -14) : std::ldexp(1 + fraction, exponent - 15);
}

double decode_half(std::uint32_t bits) {
    return (bits & 0x8000u ? -1 : 1) * decode_small_float(bits & 0x7fffu, 10);
}

Texel ktx2_texel(const Ktx2Contents& file, int level, int face, int x, int y) {
    const Known format = known_format(file.format);
    const std::string& data = file.levels.at(level);
    const std::size_t face_bytes = data.size() / file.faces;
    const std::size_t at =
        face * face_bytes + (static_cast<std::size_t>(y) * file.level_width(level) + x) * format.texel_bytes;
    Texel t{{0, 0, 0, 1}};
    auto real = [&](std::size_t i) {
        const std::uint32_t word = u32(data, at + 4 * i);
        float f;
        std::memcpy(&f, &word, sizeof f);
        return static_cast<double>(f);
    };
    for (std::uint32_t c = 0; c < format.channels; ++c) {
        if (file.format == 37)
            t.v[c] = static_cast<unsigned char>(data[at + c]) / 255.0;
        else if (format.type_size == 2)
            t.v[c] = decode_half(number<std::uint16_t>(data, at + 2 * c));
        else if (file.format == 122)
            t.v[c] = decode_small_float(c < 2 ? u32(data, at) >> (11 * c) & 0x7ffu : u32(data, at) >> 22,
                                        c < 2 ? 6 : 5);
        else if (file.format == 123)
            t.v[c] =
                std::ldexp(u32(data, at) >> (9 * c) & 0x1ffu, static_cast<int>(u32(data, at) >> 27) - 24);
        else
            t.v[c] = real(c);
    }
    return t;
}

} // namespace montelux
