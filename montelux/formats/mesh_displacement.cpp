#include "montelux/formats/mesh_displacement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace montelux {
namespace {

using Triangle = std::array<Index, 3>;

Triangle triangle_of(const TriangleMesh& mesh, std::size_t i) {
    return {mesh.indices[3 * i], mesh.indices[3 * i + 1], mesh.indices[3 * i + 2]};
}

Vec3d unit_or_zero(Vec3d v) {
    const double l = length(v);
    return l > 0 && std::isfinite(l) ? v / l : Vec3d{};
}

Vec3d face_normal(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    return unit_or_zero(cross(b - a, c - a));
}

// Every face counts the same, as in pbrt-v4.
void add_face_normals(TriangleMesh& mesh) {
    std::vector<Vec3d> sums(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        const Triangle t = triangle_of(mesh, i);
        const Vec3d n = face_normal(mesh, t);
        for (const Index v : t) sums[v] += n;
    }
    mesh.normals.clear();
    for (const Vec3d sum : sums) mesh.normals.push_back(Normal3f(unit_or_zero(sum)));
}

// Splits edges at their midpoints, each edge once.
class EdgeSplitter {
  public:
    EdgeSplitter(TriangleMesh& mesh, const Transform& world_from_object)
        : mesh_(mesh), world_from_object_(world_from_object) {}

    double length_of(Index a, Index b) const {
        return length(world_from_object_.point(Vec3d(mesh_.positions[a])) -
                      world_from_object_.point(Vec3d(mesh_.positions[b])));
    }

    Index middle(Index a, Index b) {
        const std::uint64_t key = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
        const auto [known, is_new] = middles_.try_emplace(key, static_cast<Index>(mesh_.positions.size()));
        if (is_new) {
            // Half of each first: the sum may overflow. Symmetric in a and b to the last bit.
            mesh_.positions.push_back(0.5f * mesh_.positions[a] + 0.5f * mesh_.positions[b]);
            mesh_.normals.push_back(
                Normal3f(unit_or_zero(Vec3d(mesh_.normals[a]) + Vec3d(mesh_.normals[b]))));
            if (!mesh_.uvs.empty()) mesh_.uvs.push_back(0.5f * mesh_.uvs[a] + 0.5f * mesh_.uvs[b]);
        }
        return known->second;
    }

  private:
    TriangleMesh& mesh_;
    const Transform& world_from_object_;
    std::unordered_map<std::uint64_t, Index> middles_;
};

// Vertices in groups of equal position, and of equal position and normal.
struct VertexGroups {
    std::vector<Index> by_position, by_normal; // of each vertex
    Index positions = 0, normals = 0;          // number of groups
};

VertexGroups group_vertices(const TriangleMesh& mesh) {
    const std::size_t count = mesh.positions.size();
    const auto position = [&](Index i) {
        const Point3f p = mesh.positions[i];
        return std::tuple(p.x, p.y, p.z);
    };
    const auto normal = [&](Index i) {
        const Normal3f n = mesh.normals[i];
        return std::tuple(n.x, n.y, n.z);
    };
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        return std::tuple(position(a), normal(a), a) < std::tuple(position(b), normal(b), b);
    });
    VertexGroups groups{std::vector<Index>(count), std::vector<Index>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        const Index v = order[i];
        const bool moved = i == 0 || position(v) != position(order[i - 1]);
        if (moved) ++groups.positions;
        if (moved || normal(v) != normal(order[i - 1])) ++groups.normals;
        groups.by_position[v] = groups.positions - 1;
        groups.by_normal[v] = groups.normals - 1;
    }
    return groups;
}

// A lower bound of what refinement gives: no triangle of edges below `edge_length` has a larger area than the
// equilateral one.
double fewest_triangles(const TriangleMesh& mesh, const Transform& world_from_object, float edge_length) {
    double area = 0;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        const Triangle t = triangle_of(mesh, i);
        std::array<Vec3d, 3> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = world_from_object.point(Vec3d(mesh.positions[t[k]]));
        area += length(cross(p[1] - p[0], p[2] - p[0])) / 2;
    }
    return area / (std::sqrt(3.0) / 4 * double(edge_length) * double(edge_length));
}

} // namespace

bool refine_edges(TriangleMesh& mesh, const Transform& world_from_object, float edge_length,
                  std::size_t most) {
    if (mesh.normals.empty())
        add_face_normals(mesh);
    else
        for (Normal3f& n : mesh.normals) n = Normal3f(unit_or_zero(Vec3d(n)));
    const std::size_t count = mesh.triangle_count();
    if (count > most || fewest_triangles(mesh, world_from_object, edge_length) > static_cast<double>(most))
        return false;
    EdgeSplitter edges(mesh, world_from_object);
    std::vector<Index> done;
    std::vector<Triangle> open;
    for (std::size_t i = 0; i < count; ++i) {
        open.push_back(triangle_of(mesh, i));
        while (!open.empty()) {
            const Triangle t = open.back();
            open.pop_back();
            std::array<double, 3> lengths;
            for (std::size_t k = 0; k < 3; ++k) lengths[k] = edges.length_of(t[k], t[(k + 1) % 3]);
            const auto k =
                static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
            if (!(lengths[k] >= static_cast<double>(edge_length))) {
                done.insert(done.end(), t.begin(), t.end());
                continue;
            }
            if (done.size() / 3 + open.size() + 2 + (count - 1 - i) > most) return false;
            const Index a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], middle = edges.middle(a, b);
            open.push_back({middle, b, c});
            open.push_back({a, middle, c});
        }
    }
    mesh.indices = std::move(done);
    return true;
}

void displace_vertices(TriangleMesh& mesh, std::span<const float> heights) {
    const VertexGroups groups = group_vertices(mesh);
    // Whether the triangle faces away from its normals.
    std::vector<bool> faces_away(mesh.triangle_count());
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        const Triangle t = triangle_of(mesh, i);
        const Vec3d n = Vec3d(mesh.normals[t[0]]) + Vec3d(mesh.normals[t[1]]) + Vec3d(mesh.normals[t[2]]);
        faces_away[i] = dot(face_normal(mesh, t), n) < 0;
    }

    struct Mean {
        Vec3d sum;
        double count = 0;
    };
    std::vector<Mean> moves(groups.positions);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        Mean& m = moves[groups.by_position[v]];
        m.sum += static_cast<double>(heights[v]) * Vec3d(mesh.normals[v]);
        m.count += 1;
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Mean& m = moves[groups.by_position[v]];
        // Zeros of either sign are one point.
        mesh.positions[v] = Point3f(Vec3d(mesh.positions[v]) + Vec3d{} + m.sum / m.count);
    }

    std::vector<Vec3d> sums(groups.normals);
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        const Triangle t = triangle_of(mesh, i);
        const Vec3d n = faces_away[i] ? -face_normal(mesh, t) : face_normal(mesh, t);
        for (const Index v : t) sums[groups.by_normal[v]] += n;
    }
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        // Where faces cancel one another the old normal stays.
        const Vec3d n = unit_or_zero(sums[groups.by_normal[v]]);
        if (length_squared(n) > 0) mesh.normals[v] = Normal3f(n);
    }
}

} // namespace montelux
