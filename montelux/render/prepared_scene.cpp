#include "montelux/render/prepared_scene.h"

namespace montelux {

PreparedScene::PreparedScene(const SceneDescription& description)
    : scene_(description.scene),
      tables_(description.scene, description.integrator.environments(), description.integrator.light_sampling,
              description.integrator.surfaces(), true),
      accelerator_(tables_.view()),
      build_seconds_(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count()) {}

std::vector<MemoryUse> PreparedScene::memory_use() const {
    std::vector<MemoryUse> table = tables_.memory_use();
    table.push_back({"ray tracer", accelerator_.bytes(), scene_.shapes.size() + scene_.instances.size(),
                     "shapes, instances"});
    return table;
}

} // namespace montelux
