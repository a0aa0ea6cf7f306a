// TextureLibrary: parameters of materials and lights from properties that are numbers, colours, spectra or textures.
#pragma once

#include <limits>
#include <map>
#include <utility>

#include "montelux/formats/mitsuba/pictures.h"
#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/formats/mitsuba/spectra.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::mitsuba {

// Of a number that is the same everywhere. Materials limit those of textures.
struct NumberRange {
    double least = 0, most = std::numeric_limits<double>::max();
};
inline constexpr NumberRange unit_range{0, 1};

class TextureLibrary {
  public:
    // Must outlive it.
    explicit TextureLibrary(SceneBuilder& builder) : builder_(builder), pictures_(builder) {}

    // The property `name` of `owner`, or `otherwise` without it. As a number, a colour is the mean of its spectrum and
    // a picture its luminance.
    FloatParameter number(Plugin& owner, std::string_view name, float otherwise, NumberRange range = {});
    SpectrumParameter spectrum(Plugin& owner, std::string_view name, float otherwise, SpectrumUse use);
    // An object of the kind texture as a number.
    FloatParameter number(const Plugin& texture);

    // Both times one another.
    FloatParameter product(const FloatParameter& a, const FloatParameter& b);
    // 1 - a
    FloatParameter complement(const FloatParameter& a);

    PictureLibrary& pictures() { return pictures_; }

  private:
    enum class Use : std::uint8_t { number, reflectance, unbounded };
    struct Node {
        Index index = no_index;
        std::size_t evaluations = 1; // of textures in one look-up
    };

    // `evaluations` grows by those of the property.
    FloatParameter number(Plugin& owner, std::string_view name, float otherwise, NumberRange range,
                          std::size_t& evaluations);
    SpectrumParameter spectrum(Plugin& owner, std::string_view name, float otherwise, SpectrumUse use,
                               std::size_t& evaluations);
    Node node(const Plugin& texture, Use use);
    Node make(const Plugin& texture, Use use);
    Node checkerboard(Plugin texture, Use use);
    Index image(const Plugin& bitmap, Use use);
    Index vertex_colors(Plugin texture, Use use);
    Index add(const FloatTexture& texture);
    Index add(const SpectrumTexture& texture);

    SceneBuilder& builder_;
    PictureLibrary pictures_;
    std::map<std::pair<std::size_t, Use>, Node> nodes_; // by Plugin::index
};

} // namespace montelux::mitsuba
