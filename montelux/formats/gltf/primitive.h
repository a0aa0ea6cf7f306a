// read_primitive: the triangles of a primitive of a glTF mesh.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "montelux/formats/gltf/document.h"
#include "montelux/formats/gltf/textures.h"
#include "montelux/mc/math/transform.h"
#include "montelux/scene/shape/shape.h"

namespace montelux::gltf {

// How a node changes the vertices of its mesh.
struct Deformation {
    std::span<const double> weights{}; // of morph targets
    std::span<const Matrix4> joints{}; // of a skin, from the mesh's space to the world; empty without one

    bool operator==(const Deformation& other) const {
        return std::ranges::equal(weights, other.weights) &&
               std::ranges::equal(joints, other.joints,
                                  [](const Matrix4& a, const Matrix4& b) { return a.m == b.m; });
    }
};

// The mesh in its own space, or with joints in the world. v of texture coordinates grows upwards, as in all of Montelux:
// it is 1 - v of the file. `uv_sets`: those that it takes. Empty, with a warning, for points and lines.
std::optional<TriangleMesh> read_primitive(Document& document, const Value& primitive, const UvSets& uv_sets,
                                           const Deformation& deformation);

// Which colours a primitive's vertices have.
struct VertexColorKinds {
    bool colors = false, opacities = false;

    auto operator<=>(const VertexColorKinds&) const = default;
};
VertexColorKinds vertex_colors_of(Document& document, const Value& primitive);

} // namespace montelux::gltf
