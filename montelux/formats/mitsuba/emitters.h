// LightReader: the emitters of a Mitsuba scene as lights.
#pragma once

#include <map>
#include <set>
#include <utility>

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/formats/mitsuba/spectra.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/light/picture_lookup.h"
#include "montelux/scene/render_settings.h"

namespace montelux::mitsuba {

class LightReader {
  public:
    // Must outlive it.
    explicit LightReader(SceneBuilder& builder) : builder_(builder) {}

    // An emitter of the scene.
    void add(Plugin emitter);
    // The emitter 'area' of a shape.
    Emission emission(Plugin emitter);
    // Whether `emission` was called for it.
    bool is_on_shape(const Plugin& emitter) const { return on_shapes_.contains(emitter.index()); }

  private:
    struct Source {
        SceneSpectrum spectrum;
        float scale = 1;
    };
    // The property `name`, a spectrum; D65 without it.
    Source source(Plugin& emitter, std::string_view name);
    // The property `name` that is a texture but no spectrum; empty for others and without the property.
    struct Picture {
        Plugin texture;
        bool equal_energy = true; // a "d65" is around it otherwise
        double scale = 1;
    };
    std::optional<Picture> picture(Plugin& emitter, std::string_view name);

    void add_point(Plugin& emitter);
    void add_spot(Plugin& emitter);
    void add_directional(Plugin& emitter);
    void add_environment(Plugin& emitter);
    void add_projector(Plugin& emitter);
    void add_sky(Plugin& emitter);

    SceneBuilder& builder_;
    std::map<std::size_t, std::pair<Index, PictureLookup>> pictures_; // on surfaces, by Plugin::index
    std::set<std::size_t> on_shapes_;                                 // emitters, by Plugin::index
};

} // namespace montelux::mitsuba
