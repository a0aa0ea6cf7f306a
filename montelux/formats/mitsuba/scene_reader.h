// SceneReader: the objects of a Mitsuba scene into a SceneDescription.
#pragma once

#include "montelux/formats/load_options.h"
#include "montelux/formats/mitsuba/materials.h"
#include "montelux/formats/mitsuba/media.h"
#include "montelux/formats/mitsuba/scene_graph.h"
#include "montelux/formats/mitsuba/textures.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/render_settings.h"

namespace montelux::mitsuba {

class SceneReader {
  public:
    // All must outlive it.
    SceneReader(const SceneGraph& graph, SceneDescription& description, const LoadOptions& options);

    void read();

  private:
    const SceneGraph& graph_;
    SceneDescription& description_;
    const LoadOptions& options_;
    SceneBuilder builder_;
    TextureLibrary textures_;
    MaterialLibrary materials_;
    MediumLibrary media_;
};

} // namespace montelux::mitsuba
