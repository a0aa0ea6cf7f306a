// SceneReader: the objects of a Mitsuba scene into a SceneDescription.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "montelux/formats/load_options.h"
#include "montelux/formats/mitsuba/emitters.h"
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
    void read_settings(Plugin& scene);
    // A shape of any kind, into the world or the open group.
    void add_shape(Plugin shape);
    void add_single(Plugin shape);
    void add_instance(Plugin instance);
    // The object of a shapegroup, made at the first call; empty for a group without shapes.
    std::optional<std::string> group(Plugin shapegroup);
    // The material of a shape: its own, or the one of shapes without any.
    SurfaceLook look_of(Plugin& shape, bool emits);
    Index medium_of(Plugin& shape, std::string_view name);

    const SceneGraph& graph_;
    SceneDescription& description_;
    const LoadOptions& options_;
    SceneBuilder builder_;
    TextureLibrary textures_;
    MaterialLibrary materials_;
    MediumLibrary media_;
    LightReader lights_;
    std::optional<SurfaceLook> standard_, dark_;               // of shapes without a BSDF
    std::map<std::size_t, std::optional<std::string>> groups_; // by Plugin::index
    std::set<std::size_t> added_;                              // shapes, by Plugin::index
};

} // namespace montelux::mitsuba
