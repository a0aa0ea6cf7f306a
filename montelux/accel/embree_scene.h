// EmbreeScene: a scene's surfaces in Embree's data structures.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "montelux/accel/geometry_callbacks.h"
#include "montelux/mc/math/vector_bytes.h"
#include "montelux/scene/shape/bounds.h"

namespace montelux {

// Built once from an immutable scene, whose arrays must outlive it.
class EmbreeScene {
  public:
    // Throws Error when memory runs out or a geometry is refused. Robust: no ray passes between triangles
    // that share an edge; only benchmarks do without.
    explicit EmbreeScene(const SceneView& scene, bool robust = true);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    // Its geometries are the shapes in SceneView::world_shapes, then the instances.
    RTCScene world() const { return world_; }
    const SceneView& scene() const { return scene_; }
    // Whether surfaces depend on the time of a ray.
    bool moves() const { return moves_; }
    // Of all surfaces, in world space.
    const Bounds3& bounds() const { return bounds_; }
    // Memory of Embree, by its own account, and of this object.
    std::size_t bytes() const {
        return static_cast<std::size_t>(embree_bytes_.load()) + vector_bytes(objects_, data_);
    }

  private:
    RTCScene new_scene() const;
    RTCGeometry mesh_geometry(const TriangleMesh& mesh, bool cut_out) const;
    RTCGeometry user_geometry(std::size_t primitives) const;
    void attach_shape(RTCScene to, unsigned id, Index shape_index);
    void attach_instance(unsigned id, const Instance& instance) const;
    void build();
    void check() const;
    void release();

    std::atomic<std::int64_t> embree_bytes_{0}; // its threads allocate
    RTCDevice device_ = nullptr;
    RTCScene world_ = nullptr;
    std::vector<RTCScene> objects_;
    std::vector<GeometryData> data_; // one per shape
    SceneView scene_;
    bool robust_, moves_;
    Bounds3 bounds_;
    std::string error_;
};

} // namespace montelux
