#include "montelux/formats/loop_subdivision.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Half-edge 3 f + k runs from corner k of triangle f to the next corner; its twin runs back in the
// neighbouring triangle, and is `no_index` on a boundary.
Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }

struct Mesh {
    std::vector<Vec3d> positions;
    std::vector<Index> corners;  // vertex at the start of each half-edge
    std::vector<Index> twins;    // of each half-edge
    std::vector<Index> outgoing; // of each vertex, a half-edge that starts there; none if it is unused

    Index head(Index h) const { return corners[next(h)]; }
};

struct Ring {
    std::vector<Index> vertices;
    bool boundary = false;
};

// The neighbours of a vertex in clockwise order, from the side where triangles run anticlockwise, inside; in
// anticlockwise order, from one boundary neighbour to the other, on a boundary.
void find_ring(const Mesh& mesh, Index vertex, Ring& ring) {
    ring.vertices.clear();
    ring.boundary = false;
    Index start = mesh.outgoing[vertex];
    if (start == no_index) return;
    Index h = start;
    do {
        ring.vertices.push_back(mesh.head(h));
        if (mesh.twins[h] == no_index) {
            ring.boundary = true;
            break;
        }
        h = next(mesh.twins[h]);
    } while (h != start);
    if (!ring.boundary) return;
    ring.vertices.assign(1, mesh.head(h));
    for (; h != no_index; h = mesh.twins[previous(h)]) ring.vertices.push_back(mesh.corners[previous(h)]);
}

double beta(std::size_t valence) {
    return valence == 3 ? 3.0 / 16 : 3.0 / (8 * static_cast<double>(valence));
}

Vec3d weigh(const Mesh& mesh, Index vertex, const Ring& ring, double interior, double boundary) {
    Vec3d p = mesh.positions[vertex];
    if (ring.vertices.empty()) return p;
    if (ring.boundary)
        return (1 - 2 * boundary) * p +
               boundary * (mesh.positions[ring.vertices.front()] + mesh.positions[ring.vertices.back()]);
    Vec3d sum;
    for (Index v : ring.vertices) sum += mesh.positions[v];
    return (1 - static_cast<double>(ring.vertices.size()) * interior) * p + interior * sum;
}

Mesh make_mesh(std::span<const Vec3f> positions, std::span<const Index> indices) {
    Mesh mesh;
    for (Vec3f p : positions) mesh.positions.push_back(Vec3d(p));
    mesh.corners.assign(indices.begin(), indices.end());
    mesh.outgoing.assign(positions.size(), no_index);
    mesh.twins.assign(indices.size(), no_index);
    std::vector<std::pair<std::uint64_t, Index>> edges; // (from, to) of each half-edge
    edges.reserve(indices.size());
    for (Index h = 0; h < indices.size(); ++h) {
        Index from = mesh.corners[h], to = mesh.head(h);
        mesh.outgoing[from] = h;
        edges.emplace_back(std::uint64_t{from} << 32 | to, h);
        if (from == to)
            throw Error("loop subdivision", "triangle " + std::to_string(h / 3) + " uses vertex " +
                                                std::to_string(from) + " twice");
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (i > 0 && edges[i].first == edges[i - 1].first)
            throw Error("loop subdivision",
                        "triangles " + std::to_string(edges[i - 1].second / 3) + " and " +
                            std::to_string(edges[i].second / 3) +
                            " run through one edge in the same direction; expected a mesh of one orientation "
                            "with at most two triangles an edge");
        std::uint64_t reversed = edges[i].first << 32 | edges[i].first >> 32;
        auto twin = std::lower_bound(edges.begin(), edges.end(), std::pair(reversed, Index{0}));
        if (twin != edges.end() && twin->first == reversed) mesh.twins[edges[i].second] = twin->second;
    }
    return mesh;
}

// Child j of triangle f (index 4 f + j) keeps corner j; child 3 is the one in the middle. In child j, corner
// j is the old vertex, corner j + 1 the new one on edge j, corner j + 2 the new one on edge j + 2.
Mesh refine(const Mesh& old) {
    Mesh mesh;
    Index half_edges = static_cast<Index>(old.corners.size());
    Ring ring;
    mesh.positions.reserve(old.positions.size() + half_edges / 2);
    for (Index v = 0; v < old.positions.size(); ++v) {
        find_ring(old, v, ring);
        mesh.positions.push_back(
            weigh(old, v, ring, beta(std::max<std::size_t>(ring.vertices.size(), 3)), 1.0 / 8));
    }
    std::vector<Index> odd(half_edges); // new vertex on each half-edge
    auto child = [](Index h, Index corner) { return 3 * (4 * (h / 3) + h % 3) + corner % 3; };
    auto middle = [](Index h, Index corner) { return 3 * (4 * (h / 3) + 3) + corner % 3; };
    for (Index v = 0; v < old.positions.size(); ++v) {
        Index h = old.outgoing[v];
        mesh.outgoing.push_back(h == no_index ? no_index : child(h, h % 3));
    }
    for (Index h = 0; h < half_edges; ++h) {
        Index twin = old.twins[h];
        if (twin != no_index && twin < h) {
            odd[h] = odd[twin];
            continue;
        }
        odd[h] = static_cast<Index>(mesh.positions.size());
        Vec3d ends = old.positions[old.corners[h]] + old.positions[old.head(h)];
        if (twin == no_index)
            mesh.positions.push_back(0.5 * ends);
        else
            mesh.positions.push_back(3.0 / 8 * ends + 1.0 / 8 *
                                                          (old.positions[old.corners[previous(h)]] +
                                                           old.positions[old.corners[previous(twin)]]));
        mesh.outgoing.push_back(middle(h, h));
    }
    mesh.corners.resize(4 * std::size_t{half_edges});
    mesh.twins.assign(4 * std::size_t{half_edges}, no_index);
    for (Index h = 0; h < half_edges; ++h) {
        Index j = h % 3;
        mesh.corners[child(h, j)] = old.corners[h];
        mesh.corners[child(h, j + 1)] = odd[h];
        mesh.corners[child(h, j + 2)] = odd[previous(h)];
        mesh.corners[middle(h, j)] = odd[h];

        mesh.twins[child(h, j + 1)] = middle(h, j + 2);
        mesh.twins[middle(h, j + 2)] = child(h, j + 1);
        if (Index twin = old.twins[h]; twin != no_index) // first half of h, second half of its twin
            mesh.twins[child(h, j)] = child(next(twin), twin % 3);
        if (Index twin = old.twins[previous(h)]; twin != no_index) // second half of the edge before h
            mesh.twins[child(h, j + 2)] = child(twin, twin % 3);
    }
    return mesh;
}

// Cross product of two tangents of the limit surface.
Vec3d limit_normal(const std::vector<Vec3d>& p, Index vertex, const Ring& ring) {
    std::size_t n = ring.vertices.size();
    Vec3d s, t;
    auto at = [&](std::size_t i) { return p[ring.vertices[i]]; };
    if (n == 0) return {};
    if (!ring.boundary) {
        for (std::size_t j = 0; j < n; ++j) {
            double angle = 2 * pi * static_cast<double>(j) / static_cast<double>(n);
            s += std::cos(angle) * at(j);
            t += std::sin(angle) * at(j);
        }
        return cross(s, t);
    }
    s = at(n - 1) - at(0);
    if (n == 2) {
        t = at(0) + at(1) - 2.0 * p[vertex];
    } else if (n == 3) {
        t = at(1) - p[vertex];
    } else if (n == 4) {
        t = 2.0 * (at(1) + at(2) - p[vertex]) - at(0) - at(3);
    } else {
        double angle = pi / static_cast<double>(n - 1);
        t = -std::sin(angle) * (at(0) + at(n - 1));
        for (std::size_t k = 1; k + 1 < n; ++k)
            t += (2 - 2 * std::cos(angle)) * std::sin(static_cast<double>(k) * angle) * at(k);
    }
    return cross(s, t);
}

} // namespace

std::size_t subdivided_count(std::size_t triangles, int levels) {
    constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
    for (int i = 0; i < levels && triangles > 0; ++i) {
        if (triangles > most / 4) return most;
        triangles *= 4;
    }
    return triangles;
}

std::size_t SubdivisionBudget::limit() const {
    constexpr std::size_t unsuspicious = std::size_t{1} << 22;
    return std::min(std::max(unsuspicious, subdivided_count(control, 5)), max_subdivided_triangles);
}

bool SubdivisionBudget::take(std::size_t triangles, int levels) {
    const std::size_t count = subdivided_count(triangles, levels);
    control += triangles;
    if (count > limit() || refined > limit() - count) return false;
    refined += count;
    return true;
}

SubdividedMesh subdivide_loop(std::span<const Vec3f> positions, std::span<const Index> indices, int levels) {
    if (subdivided_count(indices.size() / 3, levels) > max_subdivided_triangles)
        throw Error("loop subdivision", std::to_string(levels) + " levels would give more than " +
                                            std::to_string(max_subdivided_triangles) + " triangles");
    Mesh mesh = make_mesh(positions, indices);
    for (int i = 0; i < levels; ++i) mesh = refine(mesh);

    std::size_t count = mesh.positions.size();
    std::vector<Vec3d> limit(count);
    SubdividedMesh result;
    Ring ring;
    for (Index v = 0; v < count; ++v) {
        find_ring(mesh, v, ring);
        std::size_t valence = std::max<std::size_t>(ring.vertices.size(), 3);
        double gamma = 1 / (static_cast<double>(valence) + 3 / (8 * beta(valence)));
        limit[v] = weigh(mesh, v, ring, gamma, 1.0 / 5);
        result.positions.push_back(Vec3f(limit[v]));
    }
    for (Index v = 0; v < count; ++v) {
        find_ring(mesh, v, ring);
        result.normals.push_back(Vec3f(limit_normal(limit, v, ring)));
    }
    result.indices = std::move(mesh.corners);
    return result;
}

} // namespace montelux
