#include <bit>
#include <string>
#include <vector>

#include "montelux/formats/ply.h"

namespace montelux {

static_assert(std::endian::native == std::endian::little);

void write_ply(AtomicFile& file, const TriangleMesh& mesh, std::span<const Normal3f> normals) {
    std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment written by Montelux\nelement vertex " +
        std::to_string(mesh.positions.size()) + "\n";
    const auto declare = [&](const auto& values, std::initializer_list<const char*> names) {
        if (values.empty()) return;
        for (const char* name : names) header += std::string("property float ") + name + "\n";
    };
    header += "property float x\nproperty float y\nproperty float z\n";
    declare(normals, {"nx", "ny", "nz"});
    declare(mesh.uvs, {"u", "v"});
    declare(mesh.second_uvs, {"u2", "v2"});
    declare(mesh.colors, {"red", "green", "blue"});
    declare(mesh.opacities, {"alpha"});
    header += "element face " + std::to_string(mesh.indices.size() / 3) +
              "\nproperty list uchar int vertex_indices\nend_header\n";
    file.write(header.data(), header.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const auto put = [&](const auto& values) {
            if (!values.empty()) file.write(&values[i], sizeof values[i]);
        };
        put(mesh.positions);
        put(normals);
        put(mesh.uvs);
        put(mesh.second_uvs);
        put(mesh.colors);
        put(mesh.opacities);
    }
    constexpr std::uint8_t corners = 3;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        file.write(&corners, 1);
        file.write(&mesh.indices[i], 3 * sizeof mesh.indices[i]);
    }
}

} // namespace montelux
