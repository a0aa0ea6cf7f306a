// Cube maps as flat pictures: crosses, strips, six files, and a contact sheet of a chain.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "montelux/image/cube_map.h"

namespace montelux {

// Faces are placed side by side, never turned.
enum class CubeLayout {
    horizontal_cross, // 4 x 3 faces: +Y; -X +Z +X -Z; -Y. +Y above and -Y below +Z; the rest is black.
    vertical_strip,   // 1 x 6 faces: +X, -X, +Y, -Y, +Z, -Z from the top
    horizontal_strip  // 6 x 1 faces, the same from the left
};
// "cross", "vertical", "horizontal"
std::string_view name_of(CubeLayout layout);
std::optional<CubeLayout> cube_layout_named(std::string_view name);

// R, G, B in 32-bit float. Throws Error when a side would exceed Image::max_dimension.
Image lay_out(const CubeMap& map, CubeLayout layout);

// "sky.exr" becomes "sky_px.exr", and with a level "sky_m2_px.exr".
std::filesystem::path cube_face_path(const std::filesystem::path& path, CubeFace face,
                                     std::optional<int> level = {});

// A row per level, level 0 on top, and a column per face in the order of CubeFace. Every face fills a cell of
// `cell` x `cell` pixels between bars of 2 pixels: larger faces are averaged down, smaller ones enlarged
// without smoothing. Linear light; the bars are black.
struct ContactSheet {
    Image picture;
    // The automatic_exposure of the picture, for a PNG.
    float exposure = 0;
};
ContactSheet contact_sheet(const CubeMapChain& chain, int cell = 128);

} // namespace montelux
