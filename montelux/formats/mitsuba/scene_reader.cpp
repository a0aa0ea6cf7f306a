#include "montelux/formats/mitsuba/scene_reader.h"

namespace montelux::mitsuba {

SceneReader::SceneReader(const SceneGraph& graph, SceneDescription& description, const LoadOptions& options)
    : graph_(graph), description_(description), options_(options),
      builder_(description.scene, graph.diagnostics), textures_(builder_), materials_(builder_, textures_),
      media_(builder_) {}

void SceneReader::read() {
    Plugin scene(graph_, 0);
    for (const char* kind : {"sensor", "integrator", "shape", "emitter"})
        for (Plugin& plugin : scene.children(kind)) plugin.refuse();
    for (const Plugin& bsdf : scene.children("bsdf")) materials_.of(bsdf);
    scene.finish();
    builder_.finish();
}

} // namespace montelux::mitsuba
