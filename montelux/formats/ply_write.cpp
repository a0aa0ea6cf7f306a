#include <bit>
#include <string>
#include <vector>

#include "montelux/formats/ply.h"

namespace montelux {

static_assert(std::endian::native == std::endian::little);

void write_ply(AtomicFile& file, std::span<const Point3f> positions, std::span<const Normal3f> normals,
               std::span<const Point2f> uvs, std::span<const Index> indices, std::span<const Vec3f> colors,
               std::span<const float> opacities) {
    std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment written by Montelux\nelement vertex " +
        std::to_string(positions.size()) + "\nproperty float x\nproperty float y\nproperty float z\n";
    if (!normals.empty()) header += "property float nx\nproperty float ny\nproperty float nz\n";
    if (!uvs.empty()) header += "property float u\nproperty float v\n";
    if (!colors.empty()) header += "property float red\nproperty float green\nproperty float blue\n";
    if (!opacities.empty()) header += "property float alpha\n";
    header += "element face " + std::to_string(indices.size() / 3) +
              "\nproperty list uchar int vertex_indices\nend_header\n";
    file.write(header.data(), header.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        file.write(&positions[i], sizeof positions[i]);
        if (!normals.empty()) file.write(&normals[i], sizeof normals[i]);
        if (!uvs.empty()) file.write(&uvs[i], sizeof uvs[i]);
        if (!colors.empty()) file.write(&colors[i], sizeof colors[i]);
        if (!opacities.empty()) file.write(&opacities[i], sizeof opacities[i]);
    }
    constexpr std::uint8_t corners = 3;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        file.write(&corners, 1);
        file.write(&indices[i], 3 * sizeof indices[i]);
    }
}

} // namespace montelux
