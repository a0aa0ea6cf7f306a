#include "montelux/formats/pbrt/spectrum_parameter.h"

#include "montelux/mc/math/error.h"
#include "montelux/spectrum/named_spectra.h"
#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/spectrum/spd_file.h"

namespace montelux::pbrt {

Spectrum SpectrumReader::from_rgb(const Parameter& p, RgbMeaning meaning) const {
    if (p.numbers.size() != 3)
        diagnostics_.error(p.at, "parameter " + in_quotes(p.name) + " has " +
                                     std::to_string(p.numbers.size()) + " values; expected 3 (R G B)");
    Vec3f rgb(p.numbers[0], p.numbers[1], p.numbers[2]);
    if (rgb.x < 0 || rgb.y < 0 || rgb.z < 0)
        diagnostics_.error(p.at, "parameter " + in_quotes(p.name) + " has a negative component");
    const RgbColorSpace& space = p.color_space ? *p.color_space : RgbColorSpace::srgb();
    switch (meaning) {
    case RgbMeaning::albedo:
        if (max_component(rgb) > 1)
            diagnostics_.warn(p.at, "parameter " + in_quotes(p.name) +
                                        " is a reflectance with a component above 1; it is clamped to 1");
        return RgbAlbedoSpectrum(space, rgb);
    case RgbMeaning::unbounded:
        return RgbUnboundedSpectrum(space, rgb);
    case RgbMeaning::illuminant:
        break;
    }
    return RgbIlluminantSpectrum(space, rgb);
}

Spectrum SpectrumReader::from_name(const Parameter& p) {
    if (p.strings.size() != 1)
        diagnostics_.error(p.at, "parameter " + in_quotes(p.name) + " has " +
                                     std::to_string(p.strings.size()) +
                                     " values; expected 1 name of a spectrum");
    const std::string& name = p.strings[0];
    if (std::optional<Spectrum> s = find_named_spectrum(name)) return *s;
    // A name without a dot or a slash is more likely a misspelt name than a file.
    if (name.find_first_of("./\\") == std::string::npos)
        diagnostics_.error(p.at, "there is no spectrum named " + in_quotes(name) + " (did you mean '" +
                                     std::string(nearest_spectrum_name(name)) + "'?)");
    std::filesystem::path path = files_.find(name, p.at);
    if (auto known = read_.find(path.string()); known != read_.end()) return known->second;
    std::vector<std::uint8_t> bytes = files_.read(path, p.at);
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    try {
        return read_.emplace(path.string(), Spectrum(parse_spd(text, path.string()))).first->second;
    } catch (const Error& e) {
        diagnostics_.error(p.at, e.what());
    }
}

Spectrum SpectrumReader::read(const Parameter& p, RgbMeaning meaning) {
    if (p.type == ParameterType::rgb) return from_rgb(p, meaning);
    if (p.type == ParameterType::blackbody) {
        if (p.numbers.size() != 1 || !(p.numbers[0] > 0))
            diagnostics_.error(p.at, "parameter " + in_quotes(p.name) +
                                         " is no temperature; expected 1 positive number of kelvins");
        return BlackbodySpectrum(p.numbers[0]);
    }
    if (!p.strings.empty()) return from_name(p);
    if (p.numbers.empty() || p.numbers.size() % 2 != 0)
        diagnostics_.error(p.at, "parameter " + in_quotes(p.name) + " has " +
                                     std::to_string(p.numbers.size()) +
                                     " numbers; expected pairs of wavelength and value");
    try {
        return Spectrum(PiecewiseLinear::from_pairs(p.numbers));
    } catch (const Error& e) {
        diagnostics_.error(p.at, "parameter " + in_quotes(p.name) + ": " + e.what());
    }
}

} // namespace montelux::pbrt
