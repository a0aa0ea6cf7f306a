#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/formats/pbrt/coverage.h"
#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/settings.h"
#include "montelux/image/image.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/spectrum/camera_sensors.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::pbrt {
namespace {

// The pixels to render: "pixelbounds" (x0 x1 y0 y1) wins over "cropwindow" (fractions in the same order).
PixelBounds read_crop(ParameterReader& r, int width, int height) {
    PixelBounds full{0, 0, width, height}, crop = full;
    std::span<const std::int32_t> bounds = r.integers("pixelbounds");
    std::span<const float> window = r.numbers("cropwindow", ParameterType::floating);
    if (!bounds.empty()) {
        if (bounds.size() != 4)
            r.error("pixelbounds", "parameter 'pixelbounds' has " + std::to_string(bounds.size()) +
                                       " values; expected 4 (x0 x1 y0 y1)");
        if (!window.empty())
            r.diagnostics().warn(r.at("cropwindow"), "'cropwindow' is ignored: 'pixelbounds' is given, too");
        PixelBounds asked{std::min(bounds[0], bounds[1]), std::min(bounds[2], bounds[3]),
                          std::max(bounds[0], bounds[1]), std::max(bounds[2], bounds[3])};
        crop = {std::clamp(asked.x0, 0, width), std::clamp(asked.y0, 0, height),
                std::clamp(asked.x1, 0, width), std::clamp(asked.y1, 0, height)};
        if (!(crop == asked))
            r.diagnostics().warn(r.at("pixelbounds"),
                                 "'pixelbounds' reaches beyond the film and is cut to it");
    } else if (!window.empty()) {
        if (window.size() != 4)
            r.error("cropwindow", "parameter 'cropwindow' has " + std::to_string(window.size()) +
                                      " values; expected 4 (x0 x1 y0 y1)");
        auto pixel = [](int size, float fraction) {
            return std::clamp(
                static_cast<int>(std::ceil(static_cast<float>(size) * std::clamp(fraction, 0.0f, 1.0f))), 0,
                size);
        };
        crop = {pixel(width, std::min(window[0], window[1])), pixel(height, std::min(window[2], window[3])),
                pixel(width, std::max(window[0], window[1])), pixel(height, std::max(window[2], window[3]))};
    }
    if (crop.width() <= 0 || crop.height() <= 0)
        r.error(bounds.empty() ? "cropwindow" : "pixelbounds", "the crop leaves no pixel of the film");
    return crop;
}

int read_resolution(ParameterReader& r, std::string_view name, int otherwise) {
    int size = r.integer(name, otherwise);
    if (size <= 0 || size > Image::max_dimension)
        r.error(name, "parameter " + in_quotes(name) + " is " + std::to_string(size) + "; expected 1 to " +
                          std::to_string(Image::max_dimension) + " pixels");
    return size;
}

SpectralSettings read_buckets(ParameterReader& r) {
    SpectralSettings s;
    s.buckets = r.integer("nbuckets", s.buckets);
    if (s.buckets < 1 || s.buckets > SpectralSettings::most_buckets)
        r.error("nbuckets", "parameter 'nbuckets' is " + std::to_string(s.buckets) + "; expected 1 to " +
                                std::to_string(SpectralSettings::most_buckets));
    s.lambda_min = r.number("lambdamin", s.lambda_min);
    s.lambda_max = r.number("lambdamax", s.lambda_max);
    if (!(s.lambda_min >= lambda_min && s.lambda_min < s.lambda_max && s.lambda_max <= lambda_max))
        r.error(s.lambda_min >= lambda_min && s.lambda_min < lambda_max ? "lambdamax" : "lambdamin",
                "'lambdamin' and 'lambdamax' must lie between 360 and 830 nm, in this order");
    return s;
}

} // namespace

void read_film(const Plugin& plugin, Diagnostics& diagnostics, FilmSettings& film, std::string& output_file) {
    if (!is_plugin("Film", plugin.name))
        diagnostics.error(plugin.at,
                          "unknown film " + in_quotes(plugin.name) + plugin_suggestion("Film", plugin.name));
    ParameterReader r(plugin.parameters, "film " + in_quotes(plugin.name), plugin.at, diagnostics);
    if (plugin.name == "spectral") film.spectral = read_buckets(r);
    if (plugin.name == "gbuffer") {
        film.layers.set = LayerSet::gbuffer();
        film.layers.in_camera_space = r.choice("coordinatesystem", {"camera", "world"}, "camera") == "camera";
    }
    film.width = read_resolution(r, "xresolution", 1280);
    film.height = read_resolution(r, "yresolution", 720);
    film.crop = read_crop(r, film.width, film.height);
    output_file = r.string("filename", "");
    film.diagonal = r.number("diagonal", 35) * 0.001f; // millimetres
    if (!(film.diagonal > 0)) r.error("diagonal", "parameter 'diagonal' must be positive");
    film.iso = r.number("iso", 100);
    if (!(film.iso > 0)) r.error("iso", "parameter 'iso' must be positive");
    film.white_balance = r.number("whitebalance", 0);
    // CIE daylight is defined from 4000 K on; its chromaticities leave the plane of colours far below that.
    if (film.white_balance != 0 && !(film.white_balance >= 2000))
        r.error(
            "whitebalance",
            "parameter 'whitebalance' is below 2000; expected 0 (none) or a temperature of 2000 K or more");
    film.max_component_value = r.number("maxcomponentvalue", std::numeric_limits<float>::infinity());
    if (!(film.max_component_value > 0))
        r.error("maxcomponentvalue", "parameter 'maxcomponentvalue' must be positive");
    film.sensor = r.string("sensor", cie_sensor);
    const std::vector<std::string_view>& sensors = sensor_names();
    if (std::find(sensors.begin(), sensors.end(), film.sensor) == sensors.end())
        r.error("sensor", "unknown sensor " + in_quotes(film.sensor) + did_you_mean(film.sensor, sensors));
    // pbrt's default is true; a file that does not ask for it keeps its 32 bits.
    film.layers.half = r.boolean("savefp16") == true;
    film.exposure_time = r.number("exposuretime", 1);
    if (!(film.exposure_time > 0)) r.error("exposuretime", "parameter 'exposuretime' must be positive");
    r.finish();
}

PixelFilter read_filter(const Plugin& plugin, Diagnostics& diagnostics) {
    ParameterReader r(plugin.parameters, "pixel filter " + in_quotes(plugin.name), plugin.at, diagnostics);
    auto radius = [&](float otherwise) {
        float x = r.number("xradius", otherwise);
        float y = r.number("yradius", otherwise);
        if (!(x > 0)) r.error("xradius", "parameter 'xradius' must be positive");
        if (!(y > 0)) r.error("yradius", "parameter 'yradius' must be positive");
        if (x > 1024) r.error("xradius", "parameter 'xradius' is larger than 1024 pixels");
        if (y > 1024) r.error("yradius", "parameter 'yradius' is larger than 1024 pixels");
        return Vec2f(x, y);
    };
    PixelFilter filter;
    if (plugin.name == "box") {
        filter = BoxFilter{radius(0.5f)};
    } else if (plugin.name == "gaussian") {
        GaussianFilter f{radius(1.5f), r.number("sigma", 0.5f)};
        if (!(f.sigma > 0)) r.error("sigma", "parameter 'sigma' must be positive");
        filter = f;
    } else if (plugin.name == "mitchell") {
        filter = MitchellFilter{radius(2), r.number("B", 1.0f / 3), r.number("C", 1.0f / 3)};
    } else if (plugin.name == "sinc") {
        LanczosFilter f{radius(4), r.number("tau", 3)};
        if (!(f.tau > 0)) r.error("tau", "parameter 'tau' must be positive");
        filter = f;
    } else if (plugin.name == "triangle") {
        filter = TriangleFilter{radius(2)};
    } else {
        r.error("unknown pixel filter " + in_quotes(plugin.name) +
                plugin_suggestion("PixelFilter", plugin.name));
    }
    r.finish();
    return filter;
}

} // namespace montelux::pbrt
