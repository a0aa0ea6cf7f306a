// TextureLibrary: parameters of materials and lights from properties that are numbers, colours, spectra or textures.
#pragma once

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/formats/mitsuba/spectra.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::mitsuba {

class TextureLibrary {
  public:
    // Must outlive it.
    explicit TextureLibrary(SceneBuilder& builder) : builder_(builder) {}

    // The property `name` of `owner`, or `otherwise` without it.
    FloatParameter number(Plugin& owner, std::string_view name, float otherwise);
    SpectrumParameter spectrum(Plugin& owner, std::string_view name, float otherwise, SpectrumUse use);

  private:
    SceneBuilder& builder_;
};

} // namespace montelux::mitsuba
