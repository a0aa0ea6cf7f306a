#include "montelux/formats/pbrt/mesh_parameters.h"

#include <string>

namespace montelux::pbrt {
namespace {

std::vector<Point2f> read_pairs(ParameterReader& r, std::string_view name) {
    const std::span<const float> numbers = r.numbers(name, ParameterType::point2, 2);
    std::vector<Point2f> pairs;
    pairs.reserve(numbers.size() / 2);
    for (std::size_t i = 0; i < numbers.size(); i += 2) pairs.emplace_back(numbers[i], numbers[i + 1]);
    return pairs;
}

template <typename Mesh>
void read_values(ParameterReader& r, Mesh& mesh) {
    mesh.normals = r.triples("N", ParameterType::normal);
    mesh.uvs = read_pairs(r, "uv");
    const auto drop_unless_one_a_vertex = [&](auto& values, std::string_view name) {
        if (values.empty() || values.size() == mesh.positions.size()) return;
        r.diagnostics().warn(r.at(name), "parameter " + in_quotes(name) + " has " +
                                             std::to_string(values.size()) + " entries for " +
                                             std::to_string(mesh.positions.size()) +
                                             " vertices; it is ignored");
        values.clear();
    };
    drop_unless_one_a_vertex(mesh.normals, "N");
    drop_unless_one_a_vertex(mesh.uvs, "uv");
    if constexpr (requires { mesh.tangents; }) {
        mesh.tangents = r.triples("S", ParameterType::vector3);
        drop_unless_one_a_vertex(mesh.tangents, "S");
    }
    if constexpr (requires { mesh.colors; }) {
        mesh.second_uvs = read_pairs(r, "uv2");
        drop_unless_one_a_vertex(mesh.second_uvs, "uv2");
        mesh.colors = r.triples("colors", ParameterType::rgb);
        drop_unless_one_a_vertex(mesh.colors, "colors");
        const std::span<const float> opacities = r.numbers("opacities", ParameterType::floating);
        mesh.opacities.assign(opacities.begin(), opacities.end());
        drop_unless_one_a_vertex(mesh.opacities, "opacities");
    }
}

} // namespace

std::vector<Index> read_indices(ParameterReader& r, std::size_t vertex_count, std::size_t corners,
                                std::string_view primitive) {
    const std::span<const std::int32_t> given = r.integers("indices");
    const std::size_t count = given.size() - given.size() % corners;
    if (count != given.size())
        r.diagnostics().warn(r.at("indices"), "parameter 'indices' has " + std::to_string(given.size()) +
                                                  " values, no multiple of " + std::to_string(corners) +
                                                  "; the last " + std::to_string(given.size() - count) +
                                                  " are ignored");
    std::vector<Index> indices(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (given[i] < 0 || static_cast<std::size_t>(given[i]) >= vertex_count)
            r.error("indices", std::string(primitive) + " " + std::to_string(i / corners) +
                                   " refers to vertex " + std::to_string(given[i]) + "; the mesh has " +
                                   std::to_string(vertex_count) + " vertices");
        indices[i] = static_cast<Index>(given[i]);
    }
    return indices;
}

void read_vertex_values(ParameterReader& r, TriangleMesh& mesh) { read_values(r, mesh); }
void read_vertex_values(ParameterReader& r, BilinearMesh& mesh) { read_values(r, mesh); }

} // namespace montelux::pbrt
