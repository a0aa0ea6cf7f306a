#include "montelux/formats/vertex_normals.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

struct PositionHash {
    std::size_t operator()(const Point3f& p) const {
        std::uint64_t h = 0;
        for (int axis = 0; axis < 3; ++axis)
            h = hash_key(h, std::bit_cast<std::uint32_t>(p[axis] + 0.0f)); // -0 is 0
        return static_cast<std::size_t>(h);
    }
};
struct PositionsEqual {
    bool operator()(const Point3f& a, const Point3f& b) const {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
};

Vec3d unit_or_zero(Vec3d v) {
    const double l = length(v);
    return l > 0 ? v / l : Vec3d{};
}

// The corners around one vertex, in sets that smooth edges join.
class CornerSets {
  public:
    void reset(std::size_t count) {
        parent_.resize(count);
        for (std::size_t i = 0; i < count; ++i) parent_[i] = i;
    }
    std::size_t find(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::size_t a, std::size_t b) { parent_[find(b)] = find(a); }

  private:
    std::vector<std::size_t> parent_;
};

} // namespace

std::vector<Index> welded(std::span<const Point3f> positions) {
    std::vector<Index> first(positions.size());
    std::unordered_map<Point3f, Index, PositionHash, PositionsEqual> known;
    known.reserve(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        first[i] = known.try_emplace(positions[i], static_cast<Index>(i)).first->second;
    return first;
}

CornerNormals corner_normals(std::span<const Point3f> positions, std::span<const Index> indices,
                             std::span<const std::uint32_t> groups) {
    const double crease = std::cos(crease_degrees * pi / 180);
    const std::size_t triangles = indices.size() / 3;
    std::vector<Vec3f> facing(triangles); // unit
    for (std::size_t t = 0; t < triangles; ++t) {
        const Vec3d a(positions[indices[3 * t]]), b(positions[indices[3 * t + 1]]),
            c(positions[indices[3 * t + 2]]);
        facing[t] = Vec3f(unit_or_zero(cross(b - a, c - a)));
    }
    const auto is_smooth = [&](std::size_t t, std::size_t u) {
        if (!groups.empty()) return groups[t] != 0 && groups[t] == groups[u];
        return double(dot(facing[t], facing[u])) >= crease;
    };
    // The corners of each vertex: those of vertex v from first[v] on.
    std::vector<std::size_t> first(positions.size() + 1, 0);
    for (const Index v : indices) ++first[v + std::size_t{1}];
    for (std::size_t v = 0; v < positions.size(); ++v) first[v + 1] += first[v];
    std::vector<Index> corners(indices.size());
    {
        std::vector<std::size_t> next(first.begin(), first.end() - 1);
        for (std::size_t c = 0; c < indices.size(); ++c) corners[next[indices[c]]++] = static_cast<Index>(c);
    }

    CornerNormals result;
    result.corners.resize(indices.size());
    CornerSets sets;
    std::vector<std::pair<Index, std::size_t>> edges; // the vertex at the other end, and the corner
    std::vector<Vec3d> sums;
    std::vector<Index> numbers; // of the sets' normals
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const std::span<const Index> around(corners.data() + first[v], first[v + 1] - first[v]);
        sets.reset(around.size());
        edges.clear();
        for (std::size_t i = 0; i < around.size(); ++i) {
            const std::size_t t = around[i] / 3, k = around[i] % 3;
            edges.emplace_back(indices[3 * t + (k + 1) % 3], i);
            edges.emplace_back(indices[3 * t + (k + 2) % 3], i);
        }
        std::ranges::sort(edges);
        for (std::size_t e = 1; e < edges.size(); ++e)
            if (edges[e].first == edges[e - 1].first &&
                is_smooth(around[edges[e].second] / 3, around[edges[e - 1].second] / 3))
                sets.join(edges[e - 1].second, edges[e].second);
        sums.assign(around.size(), {});
        for (std::size_t i = 0; i < around.size(); ++i) {
            const std::size_t t = around[i] / 3, k = around[i] % 3;
            const Vec3d p(positions[v]);
            const Vec3d a = unit_or_zero(Vec3d(positions[indices[3 * t + (k + 1) % 3]]) - p),
                        b = unit_or_zero(Vec3d(positions[indices[3 * t + (k + 2) % 3]]) - p);
            const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
            sums[sets.find(i)] = sums[sets.find(i)] + angle * Vec3d(facing[t]);
        }
        numbers.assign(around.size(), no_index);
        for (std::size_t i = 0; i < around.size(); ++i) {
            Index& number = numbers[sets.find(i)];
            if (number == no_index) {
                number = static_cast<Index>(result.normals.size());
                result.normals.push_back(Vec3f(unit_or_zero(sums[sets.find(i)])));
            }
            result.corners[around[i]] = number;
        }
    }
    return result;
}

void add_normals(TriangleMesh& mesh) {
    const std::vector<Index> same = welded(mesh.positions);
    std::vector<Index> topology(mesh.indices.size());
    for (std::size_t c = 0; c < topology.size(); ++c) topology[c] = same[mesh.indices[c]];
    const CornerNormals made = corner_normals(mesh.positions, topology);
    // A vertex keeps its place for the first of its normals; others have copies of it. The search for a copy is cut
    // short, so that the many triangles around one vertex take no time that is quadratic in their number.
    constexpr int most_steps = 32;
    const std::size_t vertices = mesh.positions.size();
    std::vector<Index> normal_of(vertices, no_index), next_copy(vertices, no_index);
    mesh.normals.assign(vertices, {});
    for (std::size_t c = 0; c < mesh.indices.size(); ++c) {
        Index v = mesh.indices[c];
        const Index wanted = made.corners[c];
        const Index original = v;
        for (int step = 0; step < most_steps && normal_of[v] != wanted && next_copy[v] != no_index; ++step)
            v = next_copy[v];
        if (normal_of[v] == no_index) {
            normal_of[v] = wanted;
            mesh.normals[v] = made.normals[wanted];
        } else if (normal_of[v] != wanted) {
            const auto copy = static_cast<Index>(mesh.positions.size());
            mesh.positions.push_back(mesh.positions[v]);
            mesh.normals.push_back(made.normals[wanted]);
            if (!mesh.uvs.empty()) mesh.uvs.push_back(mesh.uvs[v]);
            normal_of.push_back(wanted);
            next_copy.push_back(next_copy[original]);
            next_copy[original] = copy;
            v = copy;
        }
        mesh.indices[c] = v;
    }
}

void add_smooth_normals(TriangleMesh& mesh, std::span<const Index> same) {
    const auto place = [&](Index v) { return same.empty() ? v : same[v]; };
    std::vector<Vec3d> sums(mesh.positions.size());
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        std::array<Vec3d, 3> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = Vec3d(mesh.positions[mesh.indices[t + k]]);
        const Vec3d facing = unit_or_zero(cross(p[1] - p[0], p[2] - p[0]));
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d a = unit_or_zero(p[(k + 1) % 3] - p[k]), b = unit_or_zero(p[(k + 2) % 3] - p[k]);
            Vec3d& sum = sums[place(mesh.indices[t + k])];
            sum = sum + std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * facing;
        }
    }
    mesh.normals.resize(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.normals.size(); ++v)
        mesh.normals[v] = Vec3f(unit_or_zero(sums[place(static_cast<Index>(v))]));
}

} // namespace montelux
