#include "app/bake/bake_map.h"

#include "app/option_values.h"
#include <CLI/CLI.hpp>
#include <cstdio>

#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"

namespace montelux::app {
namespace {

// Environment maps are larger than textures: 16k x 8k floats.
constexpr std::size_t most_pixel_bytes = std::size_t{2} << 30;

EnvironmentLayout layout_of(const BakeMapOptions& options, const Image& image, bool quiet) {
    if (options.layout == "equal-area") return EnvironmentLayout::equal_area;
    if (options.layout == "auto" && image.width() == image.height()) return EnvironmentLayout::equal_area;
    if (image.width() != 2 * image.height() && !quiet)
        std::fprintf(
            stderr,
            "montelux: warning: %s: %d x %d pixels are not twice as wide as high; they are taken as the "
            "whole sphere all the same\n",
            options.file.c_str(), image.width(), image.height());
    return EnvironmentLayout::equirectangular;
}

} // namespace

void declare(CLI::App& command, BakeMapOptions& options) {
    command.add_option("FILE", options.file, "The environment map (.hdr, .exr or any picture)")->required();
    command
        .add_option(
            "--map", options.layout,
            "Layout of the map: equirectangular, equal-area (pbrt's square maps), or auto: equal-area where "
            "it is square")
        ->check(CLI::IsMember({"auto", "equirectangular", "equal-area"}))
        ->type_name("LAYOUT");
    command
        .add_option(
            "--up", options.up,
            "Axis of the cube that points up. y: the middle of the map is at +z and its right at +x; z: "
            "at +x and +y. Both are left-handed, as files of cube maps are")
        ->check(CLI::IsMember({"y", "z"}))
        ->type_name("AXIS");
    command.add_flag("--mirror", options.mirror,
                     "Exchange left and right of the cube, for engines that look it up with right-handed "
                     "directions");
    command.add_option("--turn", options.turn, "Turn the map by this angle about the up axis")
        ->type_name("DEGREES")
        ->check(number_within(-360, 360));
}

CubeFrame frame_of(const BakeMapOptions& options) {
    return {options.up == "z", options.mirror, options.turn};
}

EnvironmentMap read_map(const BakeMapOptions& options, bool quiet) {
    ReadOptions reading;
    reading.max_pixel_bytes = most_pixel_bytes;
    const Image image = read_image(options.file, reading);
    const EnvironmentLayout layout = layout_of(options, image, quiet);
    try {
        EnvironmentMap map(image, layout);
        const MapRepairs& r = map.repairs();
        if (r.negative + r.nan + r.infinite > 0)
            std::fprintf(
                stderr,
                "montelux: warning: %s: %llu samples became 0 (%llu not a number, %llu infinite, %llu "
                "negative)\n",
                options.file.c_str(), static_cast<unsigned long long>(r.negative + r.nan + r.infinite),
                static_cast<unsigned long long>(r.nan), static_cast<unsigned long long>(r.infinite),
                static_cast<unsigned long long>(r.negative));
        if (r.halvings > 0 && !quiet)
            std::fprintf(stderr, "montelux: warning: %s: the map was averaged to %d x %d texels\n",
                         options.file.c_str(), map.grid().width(), map.grid().height());
        return map;
    } catch (const Error& e) {
        throw Error(options.file, e.what());
    }
}

} // namespace montelux::app
