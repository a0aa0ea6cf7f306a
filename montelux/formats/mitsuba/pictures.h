// PictureLibrary: the pictures of a Mitsuba scene's bitmap textures; each file is read once.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::mitsuba {

// The property `to_uv`, which (u, v) are transformed by, as a mapping to (s, t) with the picture's top row at t = 1
// when `of_picture`: Mitsuba's is at v = 0. Otherwise t = v. Both coordinates are then multiplied by `repetitions`.
TextureMapping uv_mapping(Plugin& texture, bool of_picture, double repetitions = 1);

class PictureLibrary {
  public:
    // Must outlive it.
    explicit PictureLibrary(SceneBuilder& builder) : builder_(builder) {}

    // Of the texture "bitmap".
    ImageTexture texture(Plugin bitmap);
    bool has_colors(const ImageTexture& texture) const;
    // The normals of a texture, into Scene::normal_maps: a raw bitmap with colours, or the same vector everywhere.
    Index normal_map(Plugin texture);

  private:
    // Into Scene::images.
    Index image(Plugin& bitmap);

    SceneBuilder& builder_;
    std::map<std::pair<std::string, bool>, Index> images_; // by path, and whether it is raw
    std::map<std::size_t, Index> normal_maps_;             // by Plugin::index
};

} // namespace montelux::mitsuba
