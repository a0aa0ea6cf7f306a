// Writing KTX 2.0 textures: cube maps with their mip chains, and single pictures.
#pragma once

#include <filesystem>

#include "montelux/image/cube_map.h"
#include "montelux/image/texel_format.h"

namespace montelux {

// Khronos, "KTX File Format Specification" 2.0, without supercompression, with a data format descriptor of
// the Khronos Data Format Specification 1.3. Formats of texels by their names in Vulkan: R16G16B16A16_SFLOAT,
// R32G32B32A32_SFLOAT, R16G16_SFLOAT, R32G32_SFLOAT, E5B9G9R9_UFLOAT_PACK32, B10G11R11_UFLOAT_PACK32, and
// R8G8B8A8_UNORM for RGBM. Transfer function: linear. Primaries: BT.709, and none for the two-channel
// formats, which hold tables. KTXorientation is "rd": row 0 is the top one. RGBM adds the notes
// "montelux.rgbm.range" and "montelux.rgbm.power". The file appears complete or not at all. Throws Error when
// it cannot be written, or the chain, the channels or the options violate cube_map.h and texel_format.h.
TexelLosses write_ktx2(const std::filesystem::path& path, const CubeMapChain& chain,
                       const TextureOptions& options = {});
TexelLosses write_ktx2(const std::filesystem::path& path, const Image& image,
                       const TextureOptions& options = {});

} // namespace montelux
