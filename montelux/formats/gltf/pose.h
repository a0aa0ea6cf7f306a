// Pose: where the nodes of a glTF file are, and the weights of their morph targets, at rest or at a time.
#pragma once

#include <array>
#include <vector>

#include "montelux/formats/gltf/animation.h"
#include "montelux/formats/gltf/document.h"
#include "montelux/mc/math/transform.h"

namespace montelux::gltf {

// Translation, rotation (a quaternion x y z w, of any length but 0) and scale, applied from right to left.
Matrix4 matrix_of(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
                  const std::array<double, 3>& scale);
// 16 numbers, column by column.
Matrix4 matrix_of_columns(const std::vector<double>& columns);

// From a node to the world, when the shutter opens and when it closes.
struct Placement {
    Matrix4 start, end;

    bool moves() const { return start.m != end.m; }
};

// Whether there is a motion between the two, which differ; otherwise warns that the node stands still.
bool can_move(const Transform& start, const Transform& end, const Value& node);

class Pose {
  public:
    // `channels`: of animations, shown at `time`, seconds; none: at rest. Errors: nodes that are children of two, or of
    // themselves.
    Pose(Document& document, const std::vector<Channel>& channels, double time);

    // From the node to the world.
    const Matrix4& world(std::size_t node) const { return world_[node]; }
    // Of a node with a mesh; as many as its primitives have morph targets, none where it has none.
    const std::vector<double>& weights(std::size_t node) const { return weights_[node]; }
    // Nodes that are children of none.
    const std::vector<std::size_t>& roots() const { return roots_; }
    const std::vector<std::size_t>& children(std::size_t node) const { return children_[node]; }

  private:
    std::vector<Matrix4> world_;
    std::vector<std::vector<double>> weights_;
    std::vector<std::vector<std::size_t>> children_;
    std::vector<std::size_t> roots_;
};

} // namespace montelux::gltf
