#include "montelux/image/ktx1_write.h"

#include <array>
#include <limits>

#include "montelux/image/ktx_notes.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/io/file.h"
#include "montelux/mc/math/error.h"

namespace montelux {

TexelLosses write_ktx1(const std::filesystem::path& path, const CubeMapChain& chain,
                       const TextureOptions& options) {
    const std::string name = path.string();
    check_cube_map_chain(name, chain);
    const bool half = options.format == TexelFormat::rgba16f;
    if (!half && options.format != TexelFormat::rgba32f)
        throw Error(name, "KTX 1 files are written as rgba16f or rgba32f, not as " +
                              std::string(name_of(options.format)));
    const std::size_t texel_bytes = bytes_per_texel(options.format);
    auto face_bytes = [&](const CubeMap& map) { return map.faces[0].pixel_count() * texel_bytes; };
    if (face_bytes(chain.levels[0]) > std::numeric_limits<std::uint32_t>::max())
        throw Error(name, "a face of size " + std::to_string(chain.levels[0].size) +
                              " has more than the 4 GiB that KTX 1 can hold");
    const auto notes = ktx_key_values(ktx_notes(name, options, "S=r,T=d"));

    constexpr std::array<std::uint8_t, 12> identifier{0xab, 'K',  'T',  'X',  ' ',  '1',
                                                      '1',  0xbb, '\r', '\n', 0x1a, '\n'};
    constexpr std::uint32_t little_endian = 0x04030201, gl_float = 0x1406, gl_half_float = 0x140b,
                            gl_rgba = 0x1908, gl_rgba32f = 0x8814, gl_rgba16f = 0x881a;
    const auto size = static_cast<std::uint32_t>(chain.levels[0].size);
    ByteWriter head;
    head.put_all(std::span<const std::uint8_t>(identifier));
    head.put(little_endian);
    head.put(half ? gl_half_float : gl_float);
    head.put(std::uint32_t{half ? 2u : 4u}); // bytes of the word that a big-endian machine swaps
    head.put(gl_rgba);
    head.put(half ? gl_rgba16f : gl_rgba32f);
    head.put(gl_rgba);
    head.put(size);
    head.put(size);
    head.put(std::uint32_t{0}); // depth: no volume
    head.put(std::uint32_t{0}); // elements: no array
    head.put(std::uint32_t{cube_faces});
    head.put(static_cast<std::uint32_t>(chain.levels.size()));
    head.put(static_cast<std::uint32_t>(notes.size()));

    AtomicFile file(path);
    file.write(head.take());
    file.write(notes);
    TexelLosses losses;
    std::vector<std::uint8_t> bytes;
    // Texels of 8 and 16 bytes need no padding to 4.
    for (const CubeMap& map : chain.levels) {
        const auto length = static_cast<std::uint32_t>(face_bytes(map)); // of one face, in a cube map
        file.write(&length, sizeof length);
        for (const Image& face : map.faces) {
            bytes.clear();
            append_texels(bytes, name, face, options.format, options.rgbm, losses);
            file.write(bytes);
        }
    }
    file.commit();
    return losses;
}

} // namespace montelux
