#include "montelux/formats/mitsuba/spectra.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "montelux/formats/mitsuba/xml_values.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/emission.h"
#include "montelux/scene/build/quoted.h"
#include "montelux/spectrum/blackbody.h"
#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/spectrum/rgb_spectra.h"

namespace montelux::mitsuba {
namespace {

constexpr auto spectra = std::to_array<std::string_view>(
    {"uniform", "regular", "irregular", "srgb", "d65", "blackbody", "rawconstant"});

Spectrum spectrum_of_rgb(Vec3d rgb, SpectrumUse use, const Place& place) {
    for (int i = 0; i < 3; ++i)
        if (!(rgb[i] >= 0) || (use == SpectrumUse::reflectance && rgb[i] > 1))
            place.error(use == SpectrumUse::reflectance ? "a reflectance lies between 0 and 1"
                                                        : "a colour with a negative component");
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    // As in Mitsuba, a colour that can be a reflectance is one.
    if (std::max({rgb.x, rgb.y, rgb.z}) <= 1) return RgbAlbedoSpectrum(srgb, Vec3f(rgb));
    return RgbUnboundedSpectrum(srgb, Vec3f(rgb));
}

Spectrum spectrum_of_table(const SpectrumValue& table, const Place& place) {
    const auto single = [](const std::vector<double>& values) {
        std::vector<float> all;
        for (const double v : values) all.push_back(static_cast<float>(v));
        return all;
    };
    if (std::ranges::any_of(table.values, [](double v) { return v < 0; }))
        place.error("a spectrum with a negative value");
    if (table.wavelengths.empty()) return Spectrum(static_cast<float>(table.values.at(0)));
    try {
        return Spectrum(PiecewiseLinear(single(table.wavelengths), single(table.values)));
    } catch (const Error& e) {
        place.error(e.what());
    }
}

// "wavelengths" and "values", or "values" between two wavelengths, or one property "value".
Spectrum tabulated(Plugin& plugin, const Place& place) {
    if (const Property* value = plugin.find("value")) {
        if (const auto* table = std::get_if<SpectrumValue>(&value->value))
            return spectrum_of_table(*table, place);
        place.error("'value' is " + std::string(type_name(value->value)) + "; expected a spectrum");
    }
    SpectrumValue table;
    table.values = numbers_of(plugin.text("values", ""), "'values'", place);
    if (table.values.size() < 2) place.error(plugin.describe() + " needs at least two 'values'");
    if (plugin.type() == "irregular") {
        table.wavelengths = numbers_of(plugin.text("wavelengths", ""), "'wavelengths'", place);
        if (table.wavelengths.size() != table.values.size())
            place.error("'wavelengths' has " + std::to_string(table.wavelengths.size()) +
                        " numbers and 'values' " + std::to_string(table.values.size()));
    } else {
        const double first = plugin.number("wavelength_min", 360),
                     last = plugin.number("wavelength_max", 830);
        const double step = (last - first) / static_cast<double>(table.values.size() - 1);
        for (std::size_t i = 0; i < table.values.size(); ++i)
            table.wavelengths.push_back(first + step * static_cast<double>(i));
    }
    return spectrum_of_table(table, place);
}

Vec3d color_of(Plugin& plugin, std::string_view name, Vec3d otherwise, const Place& place) {
    const Property* property = plugin.find(name);
    if (property == nullptr) return otherwise;
    if (const auto* rgb = std::get_if<RgbValue>(&property->value)) return rgb->rgb;
    if (const auto* vector = std::get_if<Vec3d>(&property->value)) return *vector;
    if (const auto* number = std::get_if<double>(&property->value)) return {*number, *number, *number};
    place.error(in_quotes(name) + " is " + std::string(type_name(property->value)) + "; expected a colour");
}

// D65 times a colour.
EmittedSpectrum white_times(Vec3d rgb, double scale, const Place& place) {
    if (!(std::min({rgb.x, rgb.y, rgb.z}) >= 0) || !(scale >= 0))
        place.error("a light with a negative value");
    const RgbIlluminantSpectrum light(RgbColorSpace::srgb(), Vec3f(rgb));
    return {light, static_cast<float>(scale) * photometric_scale(light)};
}

// Of values in W/(m^2 sr nm) and the like.
EmittedSpectrum absolute(Spectrum spectrum, double scale = 1) {
    static const float unit = photometric_scale(Spectrum(1.0f));
    return {std::move(spectrum), static_cast<float>(scale) * unit};
}

// The spectrum that a plugin is, times `scale`.
EmittedSpectrum spectrum_of_plugin(Plugin plugin, SpectrumUse use) {
    const Place place(plugin.graph().diagnostics, plugin.at());
    EmittedSpectrum result;
    if (plugin.type() == "uniform" || plugin.type() == "rawconstant") {
        plugin.skip("wavelength_min");
        plugin.skip("wavelength_max");
        const Vec3d value = color_of(plugin, "value", {1, 1, 1}, place);
        if (value.x != value.y || value.y != value.z)
            place.error(plugin.describe() + " with three different values is no spectrum");
        result.spectrum = Spectrum(static_cast<float>(value.x));
    } else if (plugin.type() == "regular" || plugin.type() == "irregular") {
        result.spectrum = tabulated(plugin, place);
    } else if (plugin.type() == "srgb") {
        const bool unbounded = plugin.flag("unbounded", false) || use == SpectrumUse::unbounded;
        result.spectrum =
            spectrum_of_rgb(color_of(plugin, "color", {1, 1, 1}, place),
                            unbounded ? SpectrumUse::unbounded : SpectrumUse::reflectance, place);
    } else if (plugin.type() == "d65") {
        const EmittedSpectrum white =
            white_times(color_of(plugin, "color", {1, 1, 1}, place), plugin.number("scale", 1, 0), place);
        result = {white.spectrum, white.scale / absolute(Spectrum(1.0f)).scale};
    } else if (plugin.type() == "blackbody") {
        plugin.skip("wavelength_min");
        plugin.skip("wavelength_max");
        const double temperature = plugin.number("temperature", 5000, 1, 1e7);
        result = {BlackbodySpectrum(static_cast<float>(temperature)),
                  static_cast<float>(planck_radiance(wien_displacement / temperature * 1e9, temperature))};
    } else {
        plugin.refuse();
    }
    plugin.finish();
    return result;
}

Spectrum times(const EmittedSpectrum& s) {
    return s.scale == 1 ? s.spectrum : Spectrum(s.spectrum.tabulate(s.scale));
}

} // namespace

bool is_spectrum(const Plugin& texture) {
    return texture.kind() == "texture" && std::ranges::find(spectra, texture.type()) != spectra.end();
}

Spectrum spectrum_of(const Property& property, SpectrumUse use, const SceneGraph& graph) {
    const Place place(graph.diagnostics, property.at);
    const auto number = [&](double value) {
        if (!(value >= 0) || (use == SpectrumUse::reflectance && value > 1))
            place.error(in_quotes(property.name) + " lies " +
                        (use == SpectrumUse::reflectance ? "outside of [0, 1]" : "below 0"));
        return Spectrum(static_cast<float>(value));
    };
    if (const auto* value = std::get_if<double>(&property.value)) return number(*value);
    if (const auto* value = std::get_if<std::int64_t>(&property.value))
        return number(static_cast<double>(*value));
    if (const auto* value = std::get_if<RgbValue>(&property.value))
        return spectrum_of_rgb(value->rgb, use, place);
    if (const auto* value = std::get_if<SpectrumValue>(&property.value))
        return spectrum_of_table(*value, place);
    if (const auto* value = std::get_if<ObjectIndex>(&property.value))
        if (const Plugin plugin(graph, value->value); plugin.kind() == "texture")
            return times(spectrum_of_plugin(plugin, use));
    place.error(in_quotes(property.name) + " is " + std::string(type_name(property.value)) +
                "; expected a colour, a number or a spectrum");
}

EmittedSpectrum emitted_spectrum_of(const Property& property, const SceneGraph& graph) {
    const Place place(graph.diagnostics, property.at);
    if (const auto* value = std::get_if<double>(&property.value))
        return white_times({1, 1, 1}, *value, place);
    if (const auto* value = std::get_if<std::int64_t>(&property.value))
        return white_times({1, 1, 1}, static_cast<double>(*value), place);
    if (const auto* value = std::get_if<RgbValue>(&property.value)) return white_times(value->rgb, 1, place);
    if (const auto* value = std::get_if<SpectrumValue>(&property.value))
        return absolute(spectrum_of_table(*value, place));
    if (const auto* value = std::get_if<ObjectIndex>(&property.value))
        if (const Plugin plugin(graph, value->value); plugin.kind() == "texture") {
            EmittedSpectrum s = spectrum_of_plugin(plugin, SpectrumUse::unbounded);
            return absolute(std::move(s.spectrum), static_cast<double>(s.scale));
        }
    place.error(in_quotes(property.name) + " is " + std::string(type_name(property.value)) +
                "; expected a colour, a number or a spectrum");
}

EmittedSpectrum white_light(double value) {
    const RgbIlluminantSpectrum light(RgbColorSpace::srgb(), {1, 1, 1});
    return {light, static_cast<float>(value) * photometric_scale(light)};
}

} // namespace montelux::mitsuba
