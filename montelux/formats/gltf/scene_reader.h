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
        Matrix4 world_from_mesh;
    };

    // The nodes of the chosen scene, parents before children.
    std::vector<std::size_t> nodes_shown();
    void visit(std::size_t node);
    void add_gpu_instances(const Value& instancing, std::size_t node, std::uint64_t mesh);
    void place_meshes();
    void place_deformed(const Value& mesh, const MeshUse& use);
    // Primitives that emit light go to the world for each use, the others into an object.
    void place_object(const Value& mesh, const std::string& name, const std::vector<MeshUse>& uses);
    void add_to_world(const Value& mesh, const Value& primitive, const MeshUse& use,
                      const Deformation& deformation);
    void add_shape(TriangleMesh triangles, const Value& mesh, const Value& primitive, const SurfaceLook& look,
                   bool flipped);
    // From the mesh's space to the world; empty for a node without a skin.
    std::vector<Matrix4> joints_of(const Value& node);
    // Empty, with a warning, where it has no inverse.
    std::optional<Transform> invertible(const MeshUse& use);

    Document& document_;
    SceneDescription& description_;
    const LoadOptions& options_;
    SceneBuilder builder_;
    MaterialLibrary materials_;
    std::vector<Channel> channels_; // empty: everything at rest
    Pose pose_;
    std::vector<Value> lights_; // of KHR_lights_punctual
    std::vector<PlacedCamera> cameras_;
    std::map<std::uint64_t, std::vector<MeshUse>> uses_; // of meshes
};

} // namespace montelux::gltf
