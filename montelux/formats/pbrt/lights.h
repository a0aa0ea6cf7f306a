// Light sources of a pbrt scene file.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/settings.h"
#include "montelux/formats/pbrt/shapes.h"
#include "montelux/formats/pbrt/spectrum_parameter.h"
#include "montelux/scene/scene.h"

namespace montelux::pbrt {

// What an AreaLightSource directive asks of each shape behind it.
struct Emission {
    Spectrum spectrum;
    float scale = 1; // radiance is scale * spectrum
    bool two_sided = false;
    float power = 0; // lm of each primitive, if positive: then scale is multiplied by power / emitted power

    // The light of a shape.
    AreaLight light(Index shape, const Geometry& geometry) const;
};

// Lights are scaled so that an RGB colour of (1, 1, 1), or any other spectrum, stands for a luminance,
// illuminance or intensity of 1 in photometric units (Scene's film integrates against the CIE's Y).
class LightReader {
  public:
    LightReader(Scene& scene, Files& files, SpectrumReader& spectra, Diagnostics& diagnostics)
        : scene_(scene), files_(files), spectra_(spectra), diagnostics_(diagnostics) {}

    Light read(const Plugin& plugin, const Transform& world_from_light, const RgbColorSpace& color_space);
    Emission read_area(const Plugin& plugin, const RgbColorSpace& color_space);

  private:
    struct Source {
        Spectrum spectrum;
        float scale = 1;
    };
    Source source(ParameterReader& r, std::string_view name, const RgbColorSpace& color_space);
    static std::optional<Portal> portal(ParameterReader& r);
    Light infinite(ParameterReader& r, const Transform& world_from_light, const RgbColorSpace& color_space);
    // The sky; its sun, if one is to be seen, is added to the scene as a light before it.
    Light sky(ParameterReader& r, const Transform& world_from_light);
    Index environment(const std::string& file, Location at);

    Scene& scene_;
    Files& files_;
    SpectrumReader& spectra_;
    Diagnostics& diagnostics_;
    std::map<std::string, Index> environments_; // by path
};

} // namespace montelux::pbrt
