#include "montelux/image/texture_header.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view ktx2_identifier = "\xabKTX 20\xbb\r\n\x1a\n"sv,
                           ktx1_identifier = "\xabKTX 11\xbb\r\n\x1a\n"sv, dds_identifier = "DDS "sv;

using NamedNumber = std::pair<std::uint32_t, std::string_view>;

// Khronos, "Vulkan Specification", VkFormat; those that textures use most.
constexpr std::array vk_formats = {NamedNumber{0, "undefined (its descriptor says)"},
                                   NamedNumber{9, "R8_UNORM"},
                                   NamedNumber{16, "R8G8_UNORM"},
                                   NamedNumber{37, "R8G8B8A8_UNORM"},
                                   NamedNumber{43, "R8G8B8A8_SRGB"},
                                   NamedNumber{76, "R16_SFLOAT"},
                                   NamedNumber{83, "R16G16_SFLOAT"},
                                   NamedNumber{97, "R16G16B16A16_SFLOAT"},
                                   NamedNumber{100, "R32_SFLOAT"},
                                   NamedNumber{103, "R32G32_SFLOAT"},
                                   NamedNumber{109, "R32G32B32A32_SFLOAT"},
                                   NamedNumber{122, "B10G11R11_UFLOAT_PACK32"},
                                   NamedNumber{123, "E5B9G9R9_UFLOAT_PACK32"},
                                   NamedNumber{131, "BC1_RGB_UNORM_BLOCK"},
                                   NamedNumber{137, "BC3_UNORM_BLOCK"},
                                   NamedNumber{139, "BC4_UNORM_BLOCK"},
                                   NamedNumber{141, "BC5_UNORM_BLOCK"},
                                   NamedNumber{143, "BC6H_UFLOAT_BLOCK"},
                                   NamedNumber{145, "BC7_UNORM_BLOCK"},
                                   NamedNumber{146, "BC7_SRGB_BLOCK"}};
constexpr std::array supercompressions = {NamedNumber{1, "BasisLZ"}, NamedNumber{2, "Zstandard"},
                                          NamedNumber{3, "ZLIB"}};
// glInternalFormat of OpenGL.
constexpr std::array gl_formats = {
    NamedNumber{0x8058, "GL_RGBA8"},   NamedNumber{0x8c43, "GL_SRGB8_ALPHA8"},
    NamedNumber{0x881a, "GL_RGBA16F"}, NamedNumber{0x8814, "GL_RGBA32F"},
    NamedNumber{0x881b, "GL_RGB16F"},  NamedNumber{0x8815, "GL_RGB32F"},
    NamedNumber{0x8c3d, "GL_RGB9_E5"}, NamedNumber{0x8c3a, "GL_R11F_G11F_B10F"}};
// Microsoft, "DXGI_FORMAT enumeration".
constexpr std::array dxgi_formats = {
    NamedNumber{2, "R32G32B32A32_FLOAT"}, NamedNumber{10, "R16G16B16A16_FLOAT"},
    NamedNumber{16, "R32G32_FLOAT"},      NamedNumber{26, "R11G11B10_FLOAT"},
    NamedNumber{28, "R8G8B8A8_UNORM"},    NamedNumber{29, "R8G8B8A8_UNORM_SRGB"},
    NamedNumber{34, "R16G16_FLOAT"},      NamedNumber{67, "R9G9B9E5_SHAREDEXP"},
    NamedNumber{71, "BC1_UNORM"},         NamedNumber{77, "BC3_UNORM"},
    NamedNumber{87, "B8G8R8A8_UNORM"},    NamedNumber{95, "BC6H_UF16"},
    NamedNumber{98, "BC7_UNORM"},         NamedNumber{99, "BC7_UNORM_SRGB"}};

std::string named(std::span<const NamedNumber> table, std::uint32_t number, const char* kind) {
    for (const auto& [known, name] : table)
        if (known == number) return std::string(name);
    return std::string(kind) + " " + std::to_string(number);
}

// Little-endian numbers at offsets, or an Error where the file ends early.
class Words {
  public:
    Words(std::span<const std::uint8_t> bytes, const std::string& name, bool swapped = false)
        : bytes_(bytes), name_(name), swapped_(swapped) {}

    std::uint32_t u32(std::size_t offset) const {
        const auto b = at(offset, 4);
        std::uint32_t v = 0;
        for (std::size_t i = 0; i < 4; ++i) v |= std::uint32_t{b[swapped_ ? 3 - i : i]} << (8 * i);
        return v;
    }
    std::uint64_t u64(std::size_t offset) const { return u32(offset) | std::uint64_t{u32(offset + 4)} << 32; }
    std::span<const std::uint8_t> at(std::uint64_t offset, std::uint64_t size) const {
        if (offset > bytes_.size() || size > bytes_.size() - offset)
            throw Error(name_, "the texture file ends early");
        return bytes_.subspan(offset, size);
    }

  private:
    std::span<const std::uint8_t> bytes_;
    const std::string& name_;
    bool swapped_;
};

std::map<std::string, std::string> notes_of(const Words& words, std::size_t offset, std::size_t size) {
    std::map<std::string, std::string> notes;
    const std::size_t end = offset + size;
    words.at(offset, size);
    while (offset + 4 <= end) {
        const std::uint32_t length = words.u32(offset);
        const auto pair = words.at(offset + 4, std::min<std::uint64_t>(length, end - offset - 4));
        const std::string text(pair.begin(), pair.end());
        const std::size_t zero = text.find('\0');
        if (zero == std::string::npos) break; // no key
        std::string value = text.substr(zero + 1);
        while (value.ends_with('\0')) value.pop_back();
        notes[text.substr(0, zero)] = value;
        offset += 4 + ((std::size_t{length} + 3) & ~std::size_t{3});
    }
    return notes;
}

void check_counts(const TextureHeader& h, const std::string& name) {
    if (h.width == 0) throw Error(name, "the texture has no texels");
    if (h.levels > 32)
        throw Error(name, "the texture has " + std::to_string(h.levels) + " levels; expected at most 32");
}

TextureHeader ktx2(const Words& words, const std::string& name) {
    TextureHeader h{.container = "KTX 2.0", .format = named(vk_formats, words.u32(12), "VkFormat")};
    h.width = words.u32(20);
    h.height = words.u32(24);
    h.depth = words.u32(28);
    h.layers = std::max(words.u32(32), 1u);
    h.faces = words.u32(36);
    h.levels = std::max(words.u32(40), 1u);
    if (const std::uint32_t scheme = words.u32(44))
        h.supercompression = named(supercompressions, scheme, "scheme");
    check_counts(h, name);
    const std::uint32_t notes_at = words.u32(56), notes_size = words.u32(60);
    for (std::uint32_t level = 0; level < h.levels; ++level) {
        const std::size_t entry = 80 + std::size_t{24} * level;
        h.level_bytes.push_back(words.at(words.u64(entry), words.u64(entry + 8)).size());
    }
    h.notes = notes_of(words, notes_at, notes_size);
    return h;
}

TextureHeader ktx1(std::span<const std::uint8_t> bytes, const std::string& name) {
    const bool swapped = Words(bytes, name).u32(12) == 0x01020304;
    const Words words(bytes, name, swapped);
    TextureHeader h{.container = "KTX 1.1", .format = named(gl_formats, words.u32(28), "glInternalFormat")};
    h.width = words.u32(36);
    h.height = words.u32(40);
    h.depth = words.u32(44);
    h.layers = std::max(words.u32(48), 1u);
    h.faces = words.u32(52);
    h.levels = std::max(words.u32(56), 1u);
    check_counts(h, name);
    h.notes = notes_of(words, 64, words.u32(60));
    return h;
}

TextureHeader dds(const Words& words, const std::string& name) {
    constexpr std::uint32_t has_depth = 0x800000, has_levels = 0x20000, has_code = 4, is_cube = 0x200,
                            cube = 4;
    TextureHeader h{.container = "DDS", .format = ""};
    const std::uint32_t flags = words.u32(8);
    h.height = words.u32(12);
    h.width = words.u32(16);
    if (flags & has_depth) h.depth = words.u32(24);
    if (flags & has_levels) h.levels = std::max(words.u32(28), 1u);
    if (words.u32(112) & is_cube) h.faces = 6;
    if (words.u32(80) & has_code) {
        const auto code = words.at(84, 4);
        const std::string text(code.begin(), code.end());
        if (text == "DX10") {
            h.format = named(dxgi_formats, words.u32(128), "DXGI_FORMAT");
            if (words.u32(136) & cube) h.faces = 6;
            h.layers = std::max(words.u32(140), 1u);
        } else if (std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 127; })) {
            h.format = text;
        } else {
            h.format = named(std::array{NamedNumber{113, "A16B16G16R16F"}, NamedNumber{116, "A32B32G32R32F"}},
                             words.u32(84), "D3DFMT");
        }
    } else {
        h.format = std::to_string(words.u32(88)) + " bits";
    }
    check_counts(h, name);
    return h;
}

} // namespace

std::optional<TextureHeader> texture_header(std::span<const std::uint8_t> bytes, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const Words words(bytes, name);
    if (text.starts_with(ktx2_identifier)) return ktx2(words, name);
    if (text.starts_with(ktx1_identifier)) return ktx1(bytes, name);
    if (text.starts_with(dds_identifier)) return dds(words, name);
    return std::nullopt;
}

} // namespace montelux
