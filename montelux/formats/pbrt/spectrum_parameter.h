// SpectrumReader: spectra from RGB colours, names, files, lists of values, black bodies.
#pragma once

#include <map>
#include <string>

#include "montelux/formats/pbrt/files.h"
#include "montelux/formats/pbrt/parameter.h"
#include "montelux/scene/texture/texture.h"
#include "montelux/spectrum/spectrum.h"

namespace montelux::pbrt {

class SpectrumReader {
  public:
    SpectrumReader(Files& files, Diagnostics& diagnostics) : files_(files), diagnostics_(diagnostics) {}

    // The parameter is of type rgb, spectrum or blackbody. Each spectrum file is read once.
    Spectrum read(const Parameter& p, RgbMeaning meaning);

  private:
    Spectrum from_rgb(const Parameter& p, RgbMeaning meaning) const;
    Spectrum from_name(const Parameter& p);

    Files& files_;
    Diagnostics& diagnostics_;
    std::map<std::string, Spectrum> read_; // by path
};

} // namespace montelux::pbrt
