#include "montelux/scene/scene_names.h"

namespace montelux {
namespace {

std::string name_or(const std::vector<std::string>& names, Index i, const char* kind) {
    if (i < names.size() && !names[i].empty()) return names[i];
    return kind + std::to_string(i);
}

} // namespace

std::string shape_name(const Scene& scene, Index shape) {
    return name_or(scene.shape_names, shape, "shape-");
}

std::string material_name(const Scene& scene, Index material) {
    return name_or(scene.material_names, material, "material-");
}

std::vector<std::string> instance_names(const Scene& scene) {
    std::vector<std::size_t> uses(scene.objects.size()), seen(scene.objects.size());
    for (const Instance& instance : scene.instances) ++uses[instance.object];
    std::vector<std::string> names;
    names.reserve(scene.instances.size());
    for (const Instance& instance : scene.instances) {
        const Index part_of = scene.objects[instance.object].part_of;
        const Index named = part_of == no_index ? instance.object : part_of;
        const ObjectDefinition& object = scene.objects[named];
        const std::size_t k = seen[instance.object]++;
        std::string name = object.name;
        if (name.empty()) {
            name = object.shapes.empty() ? "object-" + std::to_string(named)
                                         : shape_name(scene, object.shapes.front());
            if (uses[instance.object] == 1) {
                names.push_back(std::move(name));
                continue;
            }
        }
        names.push_back(name + ":" + std::to_string(k));
    }
    return names;
}

} // namespace montelux
