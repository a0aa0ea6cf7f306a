// SceneReader: the nodes of a glTF scene into a SceneDescription.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "montelux/formats/gltf/animation.h"
#include "montelux/formats/gltf/cameras_lights.h"
#include "montelux/formats/gltf/document.h"
#include "montelux/formats/gltf/materials.h"
#include "montelux/formats/gltf/pose.h"
#include "montelux/formats/load_options.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/render_settings.h"

namespace montelux::gltf {

class SceneReader {
  public:
    // All must outlive it.
    SceneReader(Document& document, SceneDescription& description, const LoadOptions& options);

    void read();

  private:
    // A mesh at a node.
    struct MeshUse {
        std::size_t node = 0;
        Placement place;
    };

    struct SceneNode {
        std::size_t number;
        bool is_visible; // its meshes and lights are, whereas cameras always count
    };
    // The nodes of the chosen scene, parents before children.
    std::vector<SceneNode> nodes_of_scene();
    void visit(SceneNode node);
    void add_gpu_instances(const Value& instancing, std::size_t node, std::uint64_t mesh);
    void place_meshes();
    void place_deformed(const Value& mesh, const MeshUse& use);
    // Primitives that emit light go to the world for each use, the others into an object.
    void place_object(const Value& mesh, const std::string& name, const std::vector<MeshUse>& uses);
    void add_to_world(const Value& mesh, const Value& primitive, const MeshUse& use,
                      const Deformation& at_start, const Deformation& at_end);
    // Empty where there is nothing to show. Of a mesh that deforms: with the vertices at both times.
    std::optional<TriangleMesh> read_deformed(const Value& primitive, const SurfaceLook& look,
                                              const Deformation& at_start, const Deformation& at_end);
    ShapeSettings settings_of(const Value& mesh, const SurfaceLook& look) const;
    // Of a node without a skin both are empty.
    struct Joints {
        std::vector<Matrix4> start, end; // from the mesh's space to the world
    };
    Joints joints_of(const Value& node);
    Placement place_of(std::size_t node) const { return {pose_.world(node), end_pose().world(node)}; }
    const Pose& end_pose() const { return end_pose_ ? *end_pose_ : pose_; }
    // When the shutter opens. Empty, with a warning, where it has no inverse.
    std::optional<Transform> start_of(const MeshUse& use);
    // When it closes, of what moves; empty, with a warning where it has no inverse, for what stands still.
    std::optional<Transform> end_of(const MeshUse& use, const Transform& start);

    Document& document_;
    SceneDescription& description_;
    const LoadOptions& options_;
    SceneBuilder builder_;
    MaterialLibrary materials_;
    std::vector<Channel> channels_; // empty: everything at rest
    Pose pose_;                     // when the shutter opens
    std::optional<Pose> end_pose_;  // when it closes; empty for a still
    std::vector<Value> lights_;     // of KHR_lights_punctual
    std::vector<PlacedCamera> cameras_;
    std::map<std::uint64_t, std::vector<MeshUse>> uses_; // of meshes
};

} // namespace montelux::gltf
