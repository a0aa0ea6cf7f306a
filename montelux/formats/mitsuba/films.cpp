#include "montelux/formats/mitsuba/films.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "montelux/image/image.h"

namespace montelux::mitsuba {
namespace {

// Up to 100 pixels: each sample would cost a search through the filter's table.
constexpr double widest_filter = 100;

// Cut at four standard deviations and lowered so that it ends at 0, as ours is.
PixelFilter gaussian(double sigma) {
    const auto radius = static_cast<float>(4 * sigma);
    return GaussianFilter{.radius = {radius, radius}, .sigma = static_cast<float>(sigma)};
}

PixelFilter read_filter(Plugin rfilter) {
    PixelFilter filter;
    if (rfilter.type() == "box") {
        filter = BoxFilter{};
    } else if (rfilter.type() == "tent") {
        const auto radius = static_cast<float>(rfilter.number("radius", 1, 1e-3, widest_filter));
        filter = TriangleFilter{.radius = {radius, radius}};
    } else if (rfilter.type() == "gaussian") {
        filter = gaussian(rfilter.number("stddev", 0.5, 1e-3, widest_filter / 4));
    } else if (rfilter.type() == "mitchell") {
        filter = MitchellFilter{.b = static_cast<float>(rfilter.number("B", 1.0 / 3, -10, 10)),
                                .c = static_cast<float>(rfilter.number("C", 1.0 / 3, -10, 10))};
    } else if (rfilter.type() == "catmullrom") {
        filter = MitchellFilter{.b = 0, .c = 0.5f};
    } else if (rfilter.type() == "lanczos") {
        // sinc(x) sinc(x / lobes)
        const auto lobes = static_cast<float>(rfilter.integer("lobes", 3, 1, 100));
        filter = LanczosFilter{.radius = {lobes, lobes}, .tau = lobes};
    } else {
        rfilter.refuse();
    }
    rfilter.finish();
    return filter;
}

} // namespace

FilmSettings standard_film() {
    FilmSettings film;
    film.width = 768;
    film.height = 576;
    film.crop = {0, 0, film.width, film.height};
    film.filter = gaussian(0.5);
    return film;
}

FilmSettings read_film(Plugin plugin) {
    if (plugin.type() != "hdrfilm" && plugin.type() != "specfilm") plugin.refuse();
    FilmSettings film = standard_film();
    const auto side = [&](std::string_view name, int otherwise, std::int64_t least, std::int64_t most) {
        return static_cast<int>(plugin.integer(name, otherwise, least, most));
    };
    film.width = side("width", film.width, 1, Image::max_dimension);
    film.height = side("height", film.height, 1, Image::max_dimension);
    film.crop.x0 = side("crop_offset_x", 0, 0, film.width - 1);
    film.crop.y0 = side("crop_offset_y", 0, 0, film.height - 1);
    film.crop.x1 = film.crop.x0 + side("crop_width", film.width - film.crop.x0, 1, film.width - film.crop.x0);
    film.crop.y1 =
        film.crop.y0 + side("crop_height", film.height - film.crop.y0, 1, film.height - film.crop.y0);
    if (const std::optional<Plugin> rfilter = plugin.child("rfilter")) film.filter = read_filter(*rfilter);
    // What the file that Mitsuba writes would hold, and how its samples are put into it.
    for (const char* name : {"file_format", "pixel_format", "component_format", "sample_border", "compensate",
                             "banner", "high_quality_edges", "attach_log"})
        plugin.skip(name);
    if (plugin.type() == "specfilm")
        plugin.warn("the channels of the film 'specfilm' are ignored: the picture is RGB");
    else
        plugin.finish(); // each spectrum of a specfilm has a name of its own
    return film;
}

SamplerSettings standard_sampler() { return {.kind = SamplerKind::independent, .spp = 4}; }

SamplerSettings read_sampler(Plugin plugin) {
    constexpr auto known = std::to_array<std::string_view>(
        {"independent", "stratified", "multijitter", "orthogonal", "ldsampler"});
    if (std::ranges::find(known, plugin.type()) == known.end()) plugin.refuse();
    SamplerSettings sampler = standard_sampler();
    sampler.spp = static_cast<std::uint32_t>(
        plugin.integer("sample_count", sampler.spp, 1, std::numeric_limits<std::uint32_t>::max()));
    sampler.seed =
        static_cast<std::uint64_t>(plugin.integer("seed", 0, 0, std::numeric_limits<std::int64_t>::max()));
    if (plugin.type() == "stratified") {
        sampler.kind = SamplerKind::stratified;
    } else if (plugin.type() != "independent") {
        sampler.kind = SamplerKind::sobol;
        plugin.warn(plugin.describe() + " is replaced by Sobol' points");
    }
    for (const char* name : {"jitter", "strength"}) plugin.skip(name);
    plugin.finish();
    return sampler;
}

} // namespace montelux::mitsuba
