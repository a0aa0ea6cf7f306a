// Writing KTX 1 textures: cube maps with their mip chains, for engines that only read version 1.
#pragma once

#include <filesystem>

#include "montelux/image/cube_map.h"
#include "montelux/image/texel_format.h"

namespace montelux {

// Khronos, "KTX File Format Specification" 1.0. Formats: rgba16f (GL_RGBA16F) and rgba32f (GL_RGBA32F).
// KTXorientation is "S=r,T=d": row 0 is the top one. Filament reads the irradiance from the note "sh", nine
// lines of three numbers.
// The file appears complete or not at all. Throws Error like write_ktx2, and on another format.
TexelLosses write_ktx1(const std::filesystem::path& path, const CubeMapChain& chain,
                       const TextureOptions& options = {});

} // namespace montelux
