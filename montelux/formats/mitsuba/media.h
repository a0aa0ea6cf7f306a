// MediumLibrary: the media of a Mitsuba scene.
#pragma once

#include <map>

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::mitsuba {

class MediumLibrary {
  public:
    // Must outlive it.
    explicit MediumLibrary(SceneBuilder& builder) : builder_(builder) {}

    // Of an object of the kind medium, made at the first call: into Scene::media.
    Index of(const Plugin& medium);

  private:
    Index make(Plugin medium);

    SceneBuilder& builder_;
    std::map<std::size_t, Index> made_; // by Plugin::index
};

} // namespace montelux::mitsuba
