// TextureLibrary: the named textures of a pbrt scene file, added to the scene when first used.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/spectrum_parameter.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::pbrt {

struct TextureDeclaration {
    std::string plugin;
    ParameterList parameters;
    Location at;
    Transform world_from_texture;
};

// Float and spectrum textures have separate names. The meaning of a colour in a spectrum texture depends on
// the parameter that uses it, so one declaration may yield up to three nodes.
class TextureLibrary {
  public:
    TextureLibrary(SceneBuilder& builder, Files& files, SpectrumReader& spectra, Diagnostics& diagnostics)
        : builder_(builder), files_(files), spectra_(spectra), diagnostics_(diagnostics) {}

    // `type` is "float" or "spectrum". Errors: another type, an unknown plugin, a name already taken.
    void declare(std::string_view type, const std::string& name, TextureDeclaration declaration);

    // A parameter that is a value or the name of a texture; empty when it is not there.
    std::optional<FloatParameter> find_float(ParameterReader& r, std::string_view name);
    std::optional<SpectrumParameter> find_spectrum(ParameterReader& r, std::string_view name,
                                                   RgbMeaning meaning);
    FloatParameter float_or(ParameterReader& r, std::string_view name, float otherwise) {
        return find_float(r, name).value_or(FloatParameter{otherwise});
    }
    SpectrumParameter spectrum_or(ParameterReader& r, std::string_view name, RgbMeaning meaning,
                                  float otherwise) {
        return find_spectrum(r, name, meaning).value_or(SpectrumParameter{otherwise});
    }

    // The index of a file's picture in Scene::images; read once for each encoding.
    Index image(const std::string& file, const std::optional<std::string>& encoding, Location at);

    // Adds a picture of normals, (n + 1) / 2, to Scene::normal_maps; filtered as in pbrt-v4.
    Index normal_map(const std::string& file, Location at);
    // The same of a spectrum texture 'imagemap', with its mapping, filter and wrapping; its factor is the map's strength.
    Index normal_map(const Parameter& texture);

    void warn_of_unused();

  private:
    struct Entry {
        TextureDeclaration declaration;
        std::size_t order = 0;
        std::array<Index, 3> nodes{no_index, no_index, no_index}; // float textures use only the first
        Index normal_map = no_index;
        std::size_t evaluations = 0; // textures evaluated per look-up, this one included
    };
    using Table = std::map<std::string, Entry, std::less<>>;

    Entry& look_up(const Parameter& p, Table& table, const Table& other, const char* type);
    Index resolve_float(Entry& entry);
    Index resolve_spectrum(Entry& entry, RgbMeaning meaning);
    template <typename Parameter>
    TextureNode<Parameter> make_node(Entry& entry, RgbMeaning meaning);
    template <typename Parameter>
    Parameter input(ParameterReader& r, std::string_view name, RgbMeaning meaning, float otherwise);
    ImageTexture image_texture(ParameterReader& r, const TextureDeclaration& d, RgbMeaning meaning);
    TextureMapping mapping(ParameterReader& r, const TextureDeclaration& d);

    SceneBuilder& builder_;
    Files& files_;
    SpectrumReader& spectra_;
    Diagnostics& diagnostics_;
    Table float_, spectrum_;
    std::map<std::string, Index> images_;
    std::map<Index, Index> normal_maps_; // by image
    std::size_t resolving_ = 0;          // how many textures are being resolved, one inside the other
    std::size_t resolving_order_ = 0;    // of the innermost of them
    std::size_t evaluations_ = 0;        // per look-up, as far as known
};

} // namespace montelux::pbrt
