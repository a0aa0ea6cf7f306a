// Light sources of a pbrt scene file.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/settings.h"
#include "montelux/formats/pbrt/spectrum_parameter.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::pbrt {

// Lights are scaled so that an RGB colour of (1, 1, 1), or any other spectrum, has a luminance, illuminance
// or intensity of 1 in photometric units (the film integrates against the CIE's Y).
class LightReader {
  public:
    LightReader(SceneBuilder& builder, Files& files, SpectrumReader& spectra, Diagnostics& diagnostics)
        : builder_(builder), files_(files), spectra_(spectra), diagnostics_(diagnostics) {}

    // Adds the light to the scene.
    void read(const Plugin& plugin, const Transform& world_from_light, const RgbColorSpace& color_space);
    Emission read_area(const Plugin& plugin, const RgbColorSpace& color_space);

  private:
    struct Source {
        SceneSpectrum spectrum;
        float scale = 1;
    };
    Source source(ParameterReader& r, std::string_view name, const RgbColorSpace& color_space);
    static std::optional<Portal> portal(ParameterReader& r);
    Light infinite(ParameterReader& r, const Transform& world_from_light, const RgbColorSpace& color_space);
    SceneBuilder::SkyLights sky(ParameterReader& r, const Transform& world_from_light);
    Index environment(const std::string& file, Location at);

    SceneBuilder& builder_;
    Files& files_;
    SpectrumReader& spectra_;
    Diagnostics& diagnostics_;
    std::map<std::string, Index> environments_; // by path
};

} // namespace montelux::pbrt
