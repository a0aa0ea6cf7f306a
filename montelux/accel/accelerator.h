// Accelerator: closest hits and occlusion of rays in the scene. The only room that names Embree.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "montelux/scene/shape/quadric.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"

namespace montelux {

class EmbreeScene;

// Built once from an immutable scene, whose arrays must outlive it; all members may be called from any
// thread.
class Accelerator {
  public:
    // Alpha cut-outs look up textures. Throws Error when memory runs out or a geometry is refused.
    explicit Accelerator(const SceneView& scene);
    ~Accelerator();
    Accelerator(Accelerator&&) noexcept;
    Accelerator& operator=(Accelerator&&) noexcept;

    // The first hit along the ray, if any.
    bool intersect(const Ray& ray, Hit& hit) const;
    // Whether anything lies within (0, t_max).
    bool occluded(const Ray& ray) const;
    // The same for many rays, in packets; `hits` and `results` have their size. Each answer is that of the ray
    // alone, to the last bit. A ray that hits nothing gets a hit with shape == no_index.
    void intersect(std::span<const Ray* const> rays, std::span<Hit> hits) const;
    void occluded(std::span<const Ray* const> rays, std::span<bool> results) const;
    // Bounds of all surfaces, in world space.
    const Bounds3& bounds() const;
    // Memory of the ray tracer's own structures, without the scene's arrays that it reads.
    std::size_t bytes() const;

  private:
    std::unique_ptr<EmbreeScene> scene_;
};

} // namespace montelux
