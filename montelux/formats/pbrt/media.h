// Participating media of a pbrt scene file.
#pragma once

#include <optional>
#include <string>

#include "montelux/formats/pbrt/files.h"
#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/spectrum_parameter.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::pbrt {

class MediumReader {
  public:
    MediumReader(SceneBuilder& builder, Files& files, SpectrumReader& spectra, Diagnostics& diagnostics)
        : builder_(builder), files_(files), spectra_(spectra), diagnostics_(diagnostics) {}

    // Adds the medium to the scene, with pbrt-v4's defaults for what is not given. `color_space` has the white of
    // light given as RGB. Its index.
    Index read(const ParameterList& parameters, const Transform& world_from_medium,
               const RgbColorSpace& color_space, Location at);

  private:
    HomogeneousMedium homogeneous(ParameterReader& r);
    GridMedium uniform_grid(ParameterReader& r, const Transform& world_from_medium);
    RgbGridMedium rgb_grid(ParameterReader& r, const Transform& world_from_medium);
    CloudMedium cloud(ParameterReader& r, const Transform& world_from_medium);
    SparseGridMedium nanovdb(ParameterReader& r, const Transform& world_from_medium);

    // sigma_a and sigma_s, or those of a preset.
    std::pair<SceneSpectrum, SceneSpectrum> coefficients(ParameterReader& r);
    SceneSpectrum coefficient(ParameterReader& r, std::string_view name);
    // Le, and the scale that makes its luminance 1; empty without one.
    std::optional<std::pair<SceneSpectrum, float>> emission(ParameterReader& r);
    std::optional<ScalarGrid> scalar_grid(ParameterReader& r, std::string_view name, std::array<int, 3> size);
    Index add(ScalarGrid grid);
    Index add(SparseGrid grid);
    Index color_grid(ParameterReader& r, std::string_view name, std::array<int, 3> size);

    SceneBuilder& builder_;
    Files& files_;
    SpectrumReader& spectra_;
    Diagnostics& diagnostics_;
};

} // namespace montelux::pbrt
