#include "montelux/image/ktx2_write.h"

#include <array>
#include <bit>
#include <numeric>
#include <vector>

#include "montelux/image/ktx_notes.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/io/file.h"
#include "montelux/mc/math/error.h"

namespace montelux {

static_assert(std::endian::native == std::endian::little, "KTX files are little-endian");

namespace {

// Khronos Data Format Specification 1.3, section 5: one piece of a texel.
struct Sample {
    int offset, bits;           // in the texel, from its least significant bit
    std::uint32_t channel;      // 0 R, 1 G, 2 B, 15 A
    std::uint32_t qualifiers;   // of the numbers below
    std::uint32_t lower, upper; // the stored values of 0 (or -1) and 1
};
constexpr std::uint32_t is_float = 0x80, is_signed = 0x40, is_exponent = 0x20;
constexpr std::uint32_t alpha = 15;

struct VulkanFormat {
    std::uint32_t number;    // of VkFormat
    std::uint32_t type_size; // bytes of the word that a big-endian machine swaps
    bool is_color;
    std::vector<Sample> samples;
};

std::vector<Sample> float_samples(int channels, int bits) {
    const auto one = std::bit_cast<std::uint32_t>(1.0f), minus_one = std::bit_cast<std::uint32_t>(-1.0f);
    std::vector<Sample> samples;
    for (int c = 0; c < channels; ++c) {
        const std::uint32_t channel = c == 3 ? alpha : static_cast<std::uint32_t>(c);
        samples.push_back({c * bits, bits, channel, is_float | is_signed, minus_one, one});
    }
    return samples;
}

VulkanFormat vulkan_format(TexelFormat format) {
    const auto one = std::bit_cast<std::uint32_t>(1.0f);
    switch (format) {
    case TexelFormat::rgba16f:
        return {97, 2, true, float_samples(4, 16)};
    case TexelFormat::rgba32f:
        return {109, 4, true, float_samples(4, 32)};
    case TexelFormat::rg16f:
        return {83, 2, false, float_samples(2, 16)};
    case TexelFormat::rg32f:
        return {103, 4, false, float_samples(2, 32)};
    case TexelFormat::rgb9e5:
        // 8448 = 33 * 2^8 is the mantissa that means 1 under the exponent 15 that the exponent's lower bound
        // names, as the specification's own example of this format has it.
        return {123,
                4,
                true,
                {{0, 9, 0, 0, 0, 8448},
                 {27, 5, 0, is_exponent, 15, 31},
                 {9, 9, 1, 0, 0, 8448},
                 {27, 5, 1, is_exponent, 15, 31},
                 {18, 9, 2, 0, 0, 8448},
                 {27, 5, 2, is_exponent, 15, 31}}};
    case TexelFormat::r11g11b10f:
        return {122,
                4,
                true,
                {{0, 11, 0, is_float, 0, one}, {11, 11, 1, is_float, 0, one}, {22, 10, 2, is_float, 0, one}}};
    case TexelFormat::rgbm8:
        break;
    }
    return {37,
            1,
            true,
            {{0, 8, 0, 0, 0, 255}, {8, 8, 1, 0, 0, 255}, {16, 8, 2, 0, 0, 255}, {24, 8, alpha, 0, 0, 255}}};
}

// Total size, then one basic descriptor block (Khronos Data Format Specification 1.3, figure 5.2).
std::vector<std::uint8_t> data_format_descriptor(const VulkanFormat& format, std::size_t texel_bytes) {
    constexpr std::uint32_t version = 2, rgbsda = 1, bt709 = 1, linear = 1;
    const auto block = static_cast<std::uint32_t>(24 + 16 * format.samples.size());
    ByteWriter bytes;
    bytes.put(block + 4);
    bytes.put(std::uint32_t{0}); // vendor: Khronos; type: basic
    bytes.put(version | block << 16);
    bytes.put(rgbsda | (format.is_color ? bt709 << 8 : 0) | linear << 16); // flags: alpha is straight
    bytes.put(std::uint32_t{0});                                           // a block is one texel
    bytes.put(static_cast<std::uint32_t>(texel_bytes));                    // one plane
    bytes.put(std::uint32_t{0});
    for (const Sample& s : format.samples) {
        bytes.put(static_cast<std::uint32_t>(s.offset | (s.bits - 1) << 16) | (s.channel | s.qualifiers)
                                                                                  << 24);
        bytes.put(std::uint32_t{0}); // position in the block
        bytes.put(s.lower);
        bytes.put(s.upper);
    }
    return bytes.take();
}

// Pictures of each level, the largest first: six of a cube map, or one.
using Levels = std::vector<std::vector<const Image*>>;

TexelLosses write_levels(const std::filesystem::path& path, const Levels& levels,
                         const TextureOptions& options) {
    const std::string name = path.string();
    check_rgbm_scale(name, options.rgbm);
    const VulkanFormat format = vulkan_format(options.format);
    const std::size_t texel_bytes = bytes_per_texel(options.format);
    const auto descriptor = data_format_descriptor(format, texel_bytes);
    const auto notes = ktx_key_values(ktx_notes(name, options, "rd"));

    constexpr std::array<std::uint8_t, 12> identifier{0xab, 'K',  'T',  'X',  ' ',  '2',
                                                      '0',  0xbb, '\r', '\n', 0x1a, '\n'};
    constexpr std::size_t header_bytes = 80, index_entry_bytes = 24;
    const std::size_t descriptor_at = header_bytes + index_entry_bytes * levels.size();
    const std::size_t notes_at = descriptor_at + descriptor.size();
    const auto word = [](std::size_t v) { return static_cast<std::uint32_t>(v); };

    ByteWriter head;
    head.put_all(std::span<const std::uint8_t>(identifier));
    head.put(format.number);
    head.put(format.type_size);
    head.put(word(levels[0][0]->width()));
    head.put(word(levels[0][0]->height()));
    head.put(std::uint32_t{0}); // depth: no volume
    head.put(std::uint32_t{0}); // layers: no array
    head.put(word(levels[0].size()));
    head.put(word(levels.size()));
    head.put(std::uint32_t{0}); // supercompression: none
    head.put(word(descriptor_at));
    head.put(word(descriptor.size()));
    head.put(word(notes_at));
    head.put(word(notes.size()));
    head.put(std::uint64_t{0}); // no supercompression, no global data for it
    head.put(std::uint64_t{0});

    // Levels are stored smallest first, each at a multiple of `alignment`.
    const std::uint64_t alignment = std::lcm(texel_bytes, std::size_t{4});
    std::vector<std::uint64_t> offsets(levels.size());
    std::uint64_t end = notes_at + notes.size();
    auto level_bytes = [&](std::size_t level) {
        return std::uint64_t{levels[level].size()} * levels[level][0]->pixel_count() * texel_bytes;
    };
    for (std::size_t level = levels.size(); level-- > 0;) {
        offsets[level] = (end + alignment - 1) / alignment * alignment;
        end = offsets[level] + level_bytes(level);
    }
    for (std::size_t level = 0; level < levels.size(); ++level) {
        head.put(offsets[level]);
        head.put(level_bytes(level));
        head.put(level_bytes(level)); // the same, uncompressed
    }

    AtomicFile file(path);
    file.write(head.take());
    file.write(descriptor);
    file.write(notes);
    TexelLosses losses;
    std::vector<std::uint8_t> bytes;
    for (std::size_t level = levels.size(); level-- > 0;) {
        bytes.assign(offsets[level] - file.position(), 0);
        file.write(bytes);
        for (const Image* image : levels[level]) {
            bytes.clear();
            append_texels(bytes, name, *image, options.format, options.rgbm, losses);
            file.write(bytes);
        }
    }
    file.commit();
    return losses;
}

} // namespace

TexelLosses write_ktx2(const std::filesystem::path& path, const CubeMapChain& chain,
                       const TextureOptions& options) {
    check_cube_map_chain(path.string(), chain);
    Levels levels;
    for (const CubeMap& map : chain.levels) {
        levels.emplace_back();
        for (const Image& face : map.faces) levels.back().push_back(&face);
    }
    return write_levels(path, levels, options);
}

TexelLosses write_ktx2(const std::filesystem::path& path, const Image& image, const TextureOptions& options) {
    if (image.empty()) throw Error(path.string(), "cannot be written: the image has no pixels");
    return write_levels(path, {{&image}}, options);
}

} // namespace montelux
