// Writing DDS textures: cube maps with their mip chains, for engines that take HDR cubes in this format.
#pragma once

#include <filesystem>

#include "montelux/image/cube_map.h"
#include "montelux/image/texel_format.h"

namespace montelux {

// Microsoft, "Reference for DDS" (Direct3D documentation), the header without the extension of Direct3D 10,
// which more readers know. Formats: rgba16f (D3DFMT_A16B16G16R16F) and rgba32f (D3DFMT_A32B32G32R32F). Each
// face is followed by its smaller levels. DDS files have no metadata: notes in the options are refused. The
// file appears complete or not at all. Throws Error like write_ktx2, and on another format.
TexelLosses write_dds(const std::filesystem::path& path, const CubeMapChain& chain,
                      const TextureOptions& options = {});

} // namespace montelux
