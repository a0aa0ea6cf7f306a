// SceneBuilder's functions for pictures and models: images of textures, environment maps, skies.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "montelux/image/half.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/scene/light/sky/sky_map.h"

namespace montelux {
namespace {

// Height of the map for sampling directions to a sky. Radiance does not depend on it.
constexpr int sky_density_rows = 256;

// A file must not keep the reader busy for an hour; scenes have one.
constexpr std::size_t most_skies = 16;

// Blocks of a TexelFile begin at multiples of this, and a process has only 65530 maps.
constexpr std::size_t least_bytes_in_file = std::size_t{1} << 16;

constexpr const char* no_colors = " has neither channels R, G and B nor Y alone";

// A NaN would spread to all texels that filtering combines with it.
std::size_t zero_what_is_not_finite(Image& picture) {
    std::size_t count = 0;
    if (picture.format() == PixelFormat::f32)
        for (float& v : picture.f32())
            if (!std::isfinite(v)) v = 0, ++count;
    if (picture.format() == PixelFormat::f16)
        for (std::uint16_t& v : picture.u16())
            if (!std::isfinite(half_to_float(v))) v = 0, ++count;
    return count;
}

} // namespace

Image rgb_map(const Image& picture) {
    std::vector<std::string> names;
    for (const int c : picture.color_channels())
        names.push_back(picture.channel_names()[static_cast<std::size_t>(c)]);
    if (names.empty()) return {};
    Image colors = picture.select(names).to_linear_f32();
    if (names.size() == 3) return colors;
    Image map(picture.width(), picture.height(), {"R", "G", "B"});
    for (std::size_t i = 0; i < map.sample_count(); ++i) map.f32()[i] = colors.f32()[i / 3];
    return map;
}

Index SceneBuilder::add_image(Image picture, const std::string& name, SourceLocation at) {
    if (picture.color_channels().empty()) messages_.error(at, name + no_colors);
    if (const std::size_t replaced = zero_what_is_not_finite(picture))
        messages_.warn(at, name + " has " + std::to_string(replaced) +
                               " values that are not finite; they count as 0");
    if (scene_.texel_file && picture.byte_count() >= least_bytes_in_file) picture.move_to(*scene_.texel_file);
    scene_.images.push_back(std::move(picture));
    return static_cast<Index>(scene_.images.size() - 1);
}

Index SceneBuilder::add_environment(const Image& picture, const std::string& name, SourceLocation at) {
    if (!layout_of_size(picture.width(), picture.height()))
        messages_.error(at, name + " has " + std::to_string(picture.width()) + " x " +
                                std::to_string(picture.height()) +
                                " pixels; an environment map must be square (equal-area octahedral), or "
                                "twice as wide as high (latitude-longitude)");
    return add_light_picture(picture, name, at);
}

Index SceneBuilder::add_light_picture(const Image& picture, const std::string& name, SourceLocation at) {
    Image map = rgb_map(picture);
    if (map.empty()) messages_.error(at, name + no_colors);
    bool negative = false, black = true;
    for (float& v : map.f32()) {
        if (!std::isfinite(v)) messages_.error(at, name + " has a pixel that is not finite");
        negative = negative || v < 0;
        v = std::max(v, 0.0f);
        black = black && v == 0;
    }
    if (black) messages_.warn(at, name + " is black; the light gives nothing");
    if (negative) messages_.warn(at, name + " has negative pixels; they count as 0");
    scene_.environments.push_back(std::move(map));
    return static_cast<Index>(scene_.environments.size() - 1);
}

void SceneBuilder::add_sky(const SkyLights& sky, SourceLocation at) {
    if (scene_.skies.size() >= most_skies)
        messages_.error(at,
                        "more than " + std::to_string(most_skies) + " skies: each takes a second to compute");
    std::optional<SkyModel> made;
    try {
        made.emplace(sky.settings);
    } catch (const Error& e) {
        messages_.error(at, e.what());
    }
    const SkyModel& model = *made;
    // Luminance in cd/m^2, as for all lights in photometric units.
    float scale = sky.scale * static_cast<float>(luminous_efficacy);
    if (sky.illuminance > 0) {
        const SpectrumTable from_sky = model.sky_irradiance(), from_sun = model.sun_irradiance();
        scale *= static_cast<float>(static_cast<double>(sky.illuminance) /
                                    (luminous_efficacy * integrate_luminance([&](float lambda) {
                                         return sky.sky_factor * from_sky(lambda) +
                                                (sky.sun ? sky.sun_factor * from_sun(lambda) : 0);
                                     })));
    }
    const bool moves = sky.world_from_light_at_end.has_value();
    const Transform place = moves ? Transform() : sky.world_from_light;
    const auto add = [&](const Light& light) {
        if (moves)
            add_moving_light(light, sky.world_from_light, *sky.world_from_light_at_end, at, sky.group);
        else
            add_light(light, at, sky.group);
    };
    if (sky.sun && sky.sun_factor > 0 && model.sun_radiance().max_value() > 0)
        add(SunLight{add_spectrum(Spectrum(model.sun_radiance())), scale * sky.sun_factor,
                     SunDisc::of_radius(normalize(place.vector(model.sun_direction())), sun_angular_radius),
                     normalize(place.normal(Vec3f(0, 0, 1)))});
    if (!(sky.sky_factor > 0)) return;
    SkyLight light;
    light.sky = static_cast<Index>(scene_.skies.size());
    light.environment = static_cast<Index>(scene_.environments.size());
    light.scale = scale * sky.sky_factor;
    light.world_from_light = place;
    scene_.environments.push_back(sky_density_map(model, sky_density_rows));
    scene_.skies.push_back(model);
    add(light);
}

} // namespace montelux
