// MediumLibrary: the media of a Mitsuba scene.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/medium/medium.h"

namespace montelux::mitsuba {

class MediumLibrary {
  public:
    // Must outlive it.
    explicit MediumLibrary(SceneBuilder& builder) : builder_(builder) {}

    // Of an object of the kind medium, made at the first call: into Scene::media.
    Index of(const Plugin& medium);

  private:
    // The samples of a file, and the box that it names.
    struct Grid {
        Index scalars = no_index, colors = no_index;
        Transform unit_from_box; // empty boxes: the identity, and `has_box` is false
        bool has_box = false;
    };
    // A property that is a volume or the same everywhere, and the place of its unit cube.
    struct PlacedField {
        MediumField field;
        Transform world_from_unit;
    };

    Index make(Plugin medium);
    Medium homogeneous(const PlacedField& extinction, const PlacedField& albedo, float scale,
                       const PhaseFunction& phase);
    PlacedField field(Plugin& medium, std::string_view name, float otherwise);
    PlacedField constant(Plugin volume);
    PlacedField grid(Plugin volume);
    Grid read_grid(const std::filesystem::path& path, SourceLocation at, const SceneGraph& graph);

    SceneBuilder& builder_;
    std::map<std::size_t, Index> made_; // by Plugin::index
    std::map<std::string, Grid> grids_; // by path
};

} // namespace montelux::mitsuba
