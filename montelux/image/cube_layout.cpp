#include "montelux/image/cube_layout.h"

#include <algorithm>
#include <string>
#include <utility>

#include "montelux/image/exposure.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

constexpr std::array<std::string_view, 3> layout_names{"cross", "vertical", "horizontal"};

struct Cell {
    int column, row;
};
// Position of each face, in the order of CubeFace.
constexpr std::array<Cell, cube_faces> cross_cells{{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}};

// Throws Error where the picture would be larger than there are.
Image blank(std::string_view what, std::int64_t width, std::int64_t height) {
    if (std::max(width, height) > Image::max_dimension)
        throw Error(what, "the picture would have " + std::to_string(width) + " x " + std::to_string(height) +
                              " pixels; at most " + std::to_string(Image::max_dimension) +
                              " on a side are possible");
    return {static_cast<int>(width), static_cast<int>(height), {"R", "G", "B"}};
}

void paste(const Image& face, Image& picture, int x0, int y0) {
    const std::size_t row = static_cast<std::size_t>(face.width()) * 3;
    for (int y = 0; y < face.height(); ++y) {
        const auto from = face.f32().subspan(face.index(0, y), row);
        std::copy(from.begin(), from.end(), picture.f32().subspan(picture.index(x0, y0 + y)).begin());
    }
}

// The half-open range of source texels that pixel i of n covers, at least one.
std::pair<int, int> covered(int i, int n, int size) {
    const int begin = static_cast<int>(std::int64_t{i} * size / n);
    const int end = static_cast<int>((std::int64_t{i} + 1) * size / n);
    return {begin, std::max(end, begin + 1)};
}

void paste_resized(const Image& face, Image& picture, int x0, int y0, int cell) {
    const int size = face.width();
    for (int y = 0; y < cell; ++y)
        for (int x = 0; x < cell; ++x) {
            const auto [left, right] = covered(x, cell, size);
            const auto [top, bottom] = covered(y, cell, size);
            for (int c = 0; c < 3; ++c) {
                double sum = 0;
                for (int v = top; v < bottom; ++v)
                    for (int u = left; u < right; ++u) sum += double{face.value(u, v, c)};
                const double count = static_cast<double>(right - left) * (bottom - top);
                picture.set(x0 + x, y0 + y, c, static_cast<float>(sum / count));
            }
        }
}

} // namespace

std::string_view name_of(CubeLayout layout) { return layout_names[static_cast<std::size_t>(layout)]; }

std::optional<CubeLayout> cube_layout_named(std::string_view name) {
    for (std::size_t i = 0; i < layout_names.size(); ++i)
        if (layout_names[i] == name) return static_cast<CubeLayout>(i);
    return {};
}

Image lay_out(const CubeMap& map, CubeLayout layout) {
    const bool cross = layout == CubeLayout::horizontal_cross,
               vertical = layout == CubeLayout::vertical_strip;
    const int columns = cross ? 4 : vertical ? 1 : 6, rows = cross ? 3 : vertical ? 6 : 1;
    Image picture = blank("cube layout", std::int64_t{columns} * map.size, std::int64_t{rows} * map.size);
    for (int i = 0; i < cube_faces; ++i) {
        const Cell cell = cross ? cross_cells[i] : vertical ? Cell{0, i} : Cell{i, 0};
        paste(map.faces[i], picture, cell.column * map.size, cell.row * map.size);
    }
    return picture;
}

std::filesystem::path cube_face_path(const std::filesystem::path& path, CubeFace face,
                                     std::optional<int> level) {
    std::string name = path.stem().string();
    if (level) name += "_m" + std::to_string(*level);
    name += "_" + std::string(name_of(face)) + path.extension().string();
    return path.parent_path() / name;
}

ContactSheet contact_sheet(const CubeMapChain& chain, int cell) {
    check_cube_map_chain("contact sheet", chain);
    if (cell < 1) throw Error("contact sheet", "the cells have a size of " + std::to_string(cell));
    constexpr int bar = 2;
    const int rows = static_cast<int>(chain.levels.size());
    const std::int64_t pitch = std::int64_t{cell} + bar;
    ContactSheet sheet;
    sheet.picture = blank("contact sheet", cube_faces * pitch + bar, rows * pitch + bar);
    for (int level = 0; level < rows; ++level)
        for (int face = 0; face < cube_faces; ++face)
            paste_resized(chain.levels[level].faces[face], sheet.picture,
                          static_cast<int>(bar + face * pitch), static_cast<int>(bar + level * pitch), cell);
    sheet.exposure = automatic_exposure(sheet.picture);
    return sheet;
}

} // namespace montelux
