// TextureLibrary: the textures of a glTF file as parameters of materials: factors times pictures.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "montelux/formats/gltf/document.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/material/parameter.h"

namespace montelux::gltf {

// The sets of texture coordinates that a material's textures use, n of TEXCOORD_n.
struct UvSets {
    std::uint64_t first = 0; // of pictures that emit, too
    std::optional<std::uint64_t> second{};
};

// A textureInfo object is `info`; without one the value is the factor alone. `vertices`: times the colours of vertices.
class TextureLibrary {
  public:
    // Both must outlive it. `pictures`: LoadOptions::pictures.
    TextureLibrary(Document& document, SceneBuilder& builder, bool pictures)
        : document_(document), builder_(builder), pictures_(pictures) {}

    // A linear factor times an sRGB picture.
    SpectrumParameter color(const std::optional<Value>& info, Vec3f factor, RgbMeaning meaning,
                            bool vertices = false);
    // A factor times a channel of a linear picture.
    FloatParameter number(const std::optional<Value>& info, float factor, ImageChannels channel,
                          bool vertices = false);
    // rgb = (n / scale + 1) / 2, a linear picture.
    NormalMapParameter normal_map(const Value& info);
    // The picture of an emissive surface, times a factor; into Scene::environments.
    Index emission(const Value& info, Vec3f factor);

    // n of TEXCOORD_n.
    static std::uint64_t uv_set(const Value& info);
    // Of the textures to come: those of the second set are mapped by it, all others by the first.
    void use(const UvSets& sets) { sets_ = sets; }

  private:
    // What is taken of a file's picture.
    enum class Use { color, linear, normal, alpha, emission };

    ImageTexture texture(const Value& info, Use use);
    Index image(const Value& source, Use use);
    // A stand-in, with a warning, where its file cannot be read.
    Image read_picture(const Value& index, Use use);
    // The index of the image that a texture shows. Errors: only one in a format that is not read.
    Value source_of(const Value& texture);
    void read_sampler(const Value& texture, ImageTexture& to);

    Document& document_;
    SceneBuilder& builder_;
    bool pictures_;
    UvSets sets_;
    std::map<std::pair<std::uint64_t, Use>, Index> images_;
};

} // namespace montelux::gltf
