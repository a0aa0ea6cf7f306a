// montelux bake sky: the clear sky as an environment map.
#include "app/bake/bake.h"
#include "app/bake/bake_run.h"
#include "app/commands.h"
#include "app/json_number.h"
#include "app/option_values.h"
#include "app/output_files.h"
#include "app/progress_line.h"
#include "app/tone_options.h"
#include "app/usage_error.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "montelux/image/image_write.h"
#include "montelux/scene/light/sky/sky_map.h"

namespace montelux::app {
namespace {

struct SkyOptions {
    std::vector<std::string> outputs;
    SkySettings settings;
    double albedo = 0.2, scale = 1;
    int size = 1024;
    ToneOptions tone{};
    bool no_sun = false;
    BakeRunOptions run;
};

double photometric(const SpectrumTable& t) {
    return luminous_efficacy * integrate_luminance([&](float lambda) { return t(lambda); });
}

// A scale that leaves nothing of the map is a mistake that its file would hide.
void scale(Image& picture, double factor) {
    const std::span<float> samples = picture.f32();
    const auto largest = static_cast<double>(*std::max_element(samples.begin(), samples.end()));
    const auto after = static_cast<float>(largest * factor);
    if (!std::isfinite(after) || (largest > 0 && !std::isnormal(after))) {
        char text[128];
        std::snprintf(text, sizeof text,
                      "%g was given; the largest value of the map, %.3g cd/m^2, becomes too %s for a float",
                      factor, largest, after < 1 ? "small" : "large");
        throw UsageError("--scale", text);
    }
    for (float& v : samples) v = static_cast<float>(static_cast<double>(v) * factor);
}

int run(const SkyOptions& o) {
    if (o.size % 2 != 0)
        throw UsageError("--size", "an even number is expected: the map is twice as wide as high");
    check_output_names(o.outputs, {});
    for (const std::string& path : o.outputs) check_writable(path);
    check(o.tone, o.outputs);
    BakeRun bake(o.run.quiet, "the sky");
    SkySettings settings = o.settings;
    settings.ground_albedo = Spectrum(static_cast<float>(o.albedo));
    const SkyModel sky(settings);
    Image picture = sky_picture(sky, o.size / 2, !o.no_sun);
    scale(picture, o.scale);
    if (bake.interrupted(bake.cancel()->requested())) return exit_interrupted;
    const double time = bake.seconds();

    OutputFiles files;
    for (const std::string& path : o.outputs)
        files.write(path, [&] {
            write_image(path, picture,
                        tone_of(o.tone, path, picture, DefaultExposure::suitable, o.run.quiet));
        });
    const double from_sky = photometric(sky.sky_irradiance()), from_sun = photometric(sky.sun_irradiance());
    const double zenith = luminous_efficacy * sky.tristimulus({0, 0, 1}).y;
    if (o.run.json) {
        nlohmann::ordered_json out;
        out["width"] = picture.width();
        out["height"] = picture.height();
        out["sky_illuminance"] = json_number(from_sky);
        out["sun_illuminance"] = json_number(from_sun);
        out["zenith_luminance"] = json_number(zenith);
        out["seconds"] = time;
        std::printf("%s\n", out.dump(2).c_str());
    } else if (!o.run.quiet) {
        for (const std::string& path : files.written())
            std::printf(
                "%s: %d x %d texels, %s; level ground gets %.4g lx from the sky and %.4g lx from the sun; "
                "zenith %.4g cd/m^2\n",
                path.c_str(), picture.width(), picture.height(), duration_text(time).c_str(), from_sky,
                from_sun, zenith);
    }
    files.throw_failures();
    return exit_done;
}

} // namespace

void add_bake_sky(CLI::App& bake, int& exit_code) {
    auto o = std::make_shared<SkyOptions>();
    o->settings.azimuth = 180; // the middle of the map
    AtmosphereSettings& air = o->settings.atmosphere;
    CLI::App* command = bake.add_subcommand("sky", "Compute a clear sky with its sun as an environment map");
    command
        ->add_option(
            "-o,--output", o->outputs,
            "Map to write, latitude-longitude, twice as wide as high; .exr, .hdr, .pfm, .png or .jpg; may be "
            "given several times")
        ->type_name("FILE")
        ->allow_extra_args(false)
        ->required();
    command->add_option("--elevation", o->settings.elevation, "Of the sun above the horizon, degrees (45)")
        ->check(number_within(lowest_sun, highest_sun))
        ->type_name("DEGREES");
    command
        ->add_option("--azimuth", o->settings.azimuth,
                     "Of the sun, degrees from the left edge of the map to the right (180, the middle)")
        ->check(number_within(-360.0, 360.0))
        ->type_name("DEGREES");
    command->add_option("--turbidity", air.turbidity, "Haze: 1 pure air, 2 a clear day (2), 10 dense haze")
        ->check(number_within(least_turbidity, most_turbidity))
        ->type_name("T");
    command->add_option("--albedo", o->albedo, "Reflectance of the ground (0.2)")
        ->check(number_within(0.0, 1.0))
        ->type_name("A");
    command->add_option("--ozone", air.ozone, "Dobson units (300)")
        ->check(number_within(0.0, 1000.0))
        ->type_name("DU");
    command->add_option("--size", o->size, "Width in texels (1024)")
        ->check(CLI::Range(2, 16384))
        ->type_name("N");
    command->add_flag("--no-sun", o->no_sun, "Leave out the sun's disc");
    add_parsed(*command, "--scale", "S", o->scale, parse_positive,
               "Multiplies the map, whose luminance is in cd/m^2 without the option");
    declare(*command, o->tone);
    declare(*command, o->run);
    command->footer(
        "The top row is the zenith; below the horizon is the ground in the light of sky and sun.\n\n"
        "Example:\n  montelux bake sky --elevation 20 --turbidity 3 -o sky.exr");
    on_command(*command, o->run, exit_code, [o] { return run(*o); });
}

} // namespace montelux::app
