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

// pbrt's illuminance of a map on an upward-facing (+z) patch: the mean over the sphere of luminance times
// positive cosine, times 2 pi. This is half the true illuminance; kept because scenes are made with pbrt.
double upper_illuminance(const Image& map, EnvironmentLayout layout);

// Lights are scaled so that an RGB colour of (1, 1, 1), or any other spectrum, has a luminance, illuminance
// or intensity of 1 in photometric units (the film integrates against the CIE's Y).
class LightReader {
  public:
    LightReader(SceneBuilder& builder, Files& files, SpectrumReader& spectra, Diagnostics& diagnostics)
        : builder_(builder), files_(files), spectra_(spectra), diagnostics_(diagnostics) {}

    // Adds the light to the scene; it moves where the transformations differ.
    void read(const Plugin& plugin, const Transform& at_start, const Transform& at_end,
              const RgbColorSpace& color_space);
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
    Light goniometric(ParameterReader& r, const Transform& world_from_light,
                      const RgbColorSpace& color_space);
    Light projection(ParameterReader& r, const Transform& world_from_light);
    // What the pixels of a map are: maps of intensity are grey, pictures have any shape.
    enum class MapUse : std::uint8_t { radiance, intensity, picture };
    // The index of a file's picture in Scene::environments; read once for each use.
    Index picture(const std::string& file, Location at, MapUse use);

    SceneBuilder& builder_;
    Files& files_;
    SpectrumReader& spectra_;
    Diagnostics& diagnostics_;
    std::map<std::pair<std::string, MapUse>, Index> pictures_; // by path
};

} // namespace montelux::pbrt
