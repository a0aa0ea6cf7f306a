#include "montelux/image/dds_write.h"

#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/io/file.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

void put_zeros(ByteWriter& bytes, int words) {
    for (int i = 0; i < words; ++i) bytes.put(std::uint32_t{0});
}

std::vector<std::uint8_t> dds_header(std::uint32_t size, std::uint32_t levels, bool half) {
    constexpr std::uint32_t caps = 0x1, height = 0x2, width = 0x4, pitch = 0x8, pixel_format = 0x1000,
                            level_count = 0x20000;
    constexpr std::uint32_t four_cc = 0x4, a16b16g16r16f = 113, a32b32g32r32f = 116;
    constexpr std::uint32_t complex = 0x8, texture = 0x1000, mipmap = 0x400000, cube_map = 0x200,
                            all_faces = 0xfc00;
    ByteWriter bytes;
    bytes.put(std::uint32_t{0x20534444}); // "DDS "
    bytes.put(std::uint32_t{124});        // of the header
    bytes.put(caps | height | width | pitch | pixel_format | level_count);
    bytes.put(size);
    bytes.put(size);
    bytes.put(size * (half ? 8 : 16)); // bytes of a row
    bytes.put(std::uint32_t{0});       // depth
    bytes.put(levels);
    put_zeros(bytes, 11);
    bytes.put(std::uint32_t{32}); // of the pixel format
    bytes.put(four_cc);
    bytes.put(half ? a16b16g16r16f : a32b32g32r32f);
    // Bits per texel are unused with a format code, but Babylon.js computes level sizes from them.
    bytes.put(std::uint32_t{half ? 64u : 128u});
    put_zeros(bytes, 4); // masks of formats without a code
    bytes.put(texture | complex | (levels > 1 ? mipmap : 0));
    bytes.put(cube_map | all_faces);
    put_zeros(bytes, 3);
    return bytes.take();
}

} // namespace

TexelLosses write_dds(const std::filesystem::path& path, const CubeMapChain& chain,
                      const TextureOptions& options) {
    const std::string name = path.string();
    check_cube_map_chain(name, chain);
    if (options.format != TexelFormat::rgba16f && options.format != TexelFormat::rgba32f)
        throw Error(name, "DDS files are written as rgba16f or rgba32f, not as " +
                              std::string(name_of(options.format)));
    if (!options.notes.empty())
        throw Error(name, "DDS files hold no notes, but there is '" + options.notes.begin()->first + "'");

    AtomicFile file(path);
    file.write(dds_header(static_cast<std::uint32_t>(chain.levels[0].size),
                          static_cast<std::uint32_t>(chain.levels.size()),
                          options.format == TexelFormat::rgba16f));
    TexelLosses losses;
    std::vector<std::uint8_t> bytes;
    for (std::size_t face = 0; face < cube_faces; ++face)
        for (const CubeMap& map : chain.levels) {
            bytes.clear();
            append_texels(bytes, name, map.faces[face], options.format, options.rgbm, losses);
            file.write(bytes);
        }
    file.commit();
    return losses;
}

} // namespace montelux
