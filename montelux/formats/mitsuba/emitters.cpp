#include "montelux/formats/mitsuba/emitters.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "montelux/formats/mitsuba/coverage.h"
#include "montelux/formats/mitsuba/light_pictures.h"
#include "montelux/formats/mitsuba/sensors.h"
#include "montelux/formats/mitsuba/sun_position.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/float_range.h"
#include "montelux/scene/build/quoted.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::mitsuba {
namespace {

// Radiance of Montelux's lights per value of a picture: its white is D65, or else the constant spectrum.
float white_of_pictures(bool equal_energy = false) {
    return photometric_scale(equal_energy ? Spectrum(1.0f) : Spectrum(RgbColorSpace::srgb().illuminant()));
}

Vec3d direction(const Plugin& emitter, Vec3d v) {
    const double l = length(v);
    if (!(l > 0) || !std::isfinite(l)) emitter.error("the light has no direction");
    return v / l;
}

Point3f position(const Plugin& emitter, Vec3d p) {
    if (!fits_float(p)) emitter.error("the light lies at infinity");
    return Vec3f(p);
}

Transform turn(Plugin& emitter) {
    const Transform to_world = emitter.transform("to_world");
    if (!turns_in_floats(to_world) || !fits_float(to_world))
        emitter.error("the light's transformation is beyond what single-precision numbers hold");
    return to_world;
}

// The top row at v = 1 instead of v = 0.
Image upside_down(const Image& picture) {
    Image turned(picture.width(), picture.height(), {"R", "G", "B"});
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < 3; ++c) turned.set(x, y, c, picture.value(x, picture.height() - 1 - y, c));
    return turned;
}

double mean_luminance(const Image& picture) {
    const Vec3d weights = RgbColorSpace::srgb().luminance_weights();
    double sum = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < 3; ++c) sum += weights[c] * double(picture.value(x, y, c));
    return sum / static_cast<double>(picture.pixel_count());
}

} // namespace

std::optional<LightReader::Picture> LightReader::picture(Plugin& emitter, std::string_view name) {
    std::optional<Plugin> texture = emitter.object(name);
    if (!texture || texture->kind() != "texture") return std::nullopt;
    if (!is_spectrum(*texture)) return Picture{*std::move(texture)};
    if (texture->type() != "d65") return std::nullopt;
    const std::optional<Plugin> inner = texture->child("texture");
    if (!inner || is_spectrum(*inner)) return std::nullopt;
    const double scale = texture->number("scale", 1, 0);
    texture->finish();
    return Picture{*inner, false, scale};
}

LightReader::Source LightReader::source(Plugin& emitter, std::string_view name) {
    if (const std::optional<Picture> found = picture(emitter, name))
        found->texture.error(in_quotes(name) + " of " + emitter.describe() +
                             " is the same in all directions; expected a spectrum");
    const Property* property = emitter.find(name);
    const EmittedSpectrum emitted =
        property != nullptr ? emitted_spectrum_of(*property, emitter.graph()) : white_light(1);
    return {builder_.add_spectrum(emitted.spectrum), emitted.scale};
}

Emission LightReader::emission(Plugin emitter) {
    if (emitter.type() != "area") {
        if (find_plugin("emitter", emitter.type()) == nullptr || emitter.type() == "directionalarea")
            emitter.refuse();
        emitter.error("a shape has " + emitter.describe() + "; surfaces shine by the emitter 'area'");
    }
    on_shapes_.insert(emitter.index());
    Emission emission;
    if (const std::optional<Picture> found = picture(emitter, "radiance")) {
        const auto [known, is_new] = pictures_.try_emplace(found->texture.index());
        if (is_new) {
            const LightPicture picture = picture_of_texture(found->texture);
            known->second = {builder_.add_light_picture(upside_down(picture.image), found->texture.describe(),
                                                        found->texture.at()),
                             picture.lookup};
        }
        std::tie(emission.picture, emission.picture_lookup) = known->second;
        emission.equal_energy = found->equal_energy;
        emission.scale = static_cast<float>(found->scale) * white_of_pictures(found->equal_energy);
        emission.picture_mean = mean_luminance(builder_.scene().environments[emission.picture]);
    } else {
        const Source s = source(emitter, "radiance");
        emission.spectrum = s.spectrum;
        emission.scale = s.scale;
    }
    emitter.skip("sampling_weight");
    emitter.finish();
    return emission;
}

void LightReader::add(Plugin emitter) {
    const std::string& type = emitter.type();
    emitter.skip("sampling_weight");
    static_cast<void>(emitter.children("medium")); // follows from the surfaces on the way to the light
    if (type == "point") {
        add_point(emitter);
    } else if (type == "spot") {
        add_spot(emitter);
    } else if (type == "directional") {
        add_directional(emitter);
    } else if (type == "constant") {
        emitter.skip("to_world");
        const Source s = source(emitter, "radiance");
        builder_.add_light(UniformInfiniteLight{s.spectrum, s.scale}, emitter.at());
    } else if (type == "envmap") {
        add_environment(emitter);
    } else if (type == "projector") {
        add_projector(emitter);
    } else if (type == "sunsky") {
        add_sky(emitter);
    } else {
        emitter.refuse();
    }
    emitter.finish();
}

void LightReader::add_point(Plugin& emitter) {
    if (emitter.has("position") && emitter.has("to_world"))
        emitter.error("'position' together with 'to_world'; expected one or the other");
    const Vec3d p = emitter.transform("to_world").point(emitter.vector("position", {}));
    const Source s = source(emitter, "intensity");
    builder_.add_light(PointLight{s.spectrum, s.scale, position(emitter, p)}, emitter.at());
}

void LightReader::add_spot(Plugin& emitter) {
    const Transform to_world = turn(emitter);
    const double end = emitter.number("cutoff_angle", 20, 0, 180);
    const double start = emitter.number("beam_width", 0.75 * end, 0, 180);
    if (!(start <= end)) emitter.error("'beam_width' is wider than 'cutoff_angle'");
    const Source s = source(emitter, "intensity");
    SpotLight light{s.spectrum, s.scale, position(emitter, to_world.point(Vec3d())),
                    Vec3f(direction(emitter, to_world.vector(Vec3d(0, 0, 1))))};
    light.cos_falloff_start = static_cast<float>(std::cos(start * pi / 180));
    light.cos_total_width = static_cast<float>(std::cos(end * pi / 180));
    light.profile = SpotFalloff::linear;
    if (const std::optional<Picture> found = picture(emitter, "texture")) {
        if (!(end < 90)) emitter.error("the picture of a spot light needs a 'cutoff_angle' below 90 degrees");
        // The square around the cone.
        const auto size = static_cast<float>(1 / std::tan(end * pi / 180));
        light.picture_x = size * Vec3f(direction(emitter, to_world.vector(Vec3d(1, 0, 0))));
        light.picture_y = size * Vec3f(direction(emitter, to_world.vector(Vec3d(0, 1, 0))));
        const LightPicture picture = picture_of_texture(found->texture);
        light.picture =
            builder_.add_light_picture(picture.image, found->texture.describe(), found->texture.at());
        light.picture_lookup = picture.lookup;
    } else if (emitter.has("texture")) {
        emitter.error("'texture' of a spot light is no picture; expected a 'bitmap'");
    }
    builder_.add_light(light, emitter.at());
}

void LightReader::add_directional(Plugin& emitter) {
    if (emitter.has("direction") && emitter.has("to_world"))
        emitter.error("'direction' together with 'to_world'; expected one or the other");
    const Vec3d towards = emitter.transform("to_world").vector(emitter.vector("direction", {0, 0, 1}));
    const Source s = source(emitter, "irradiance");
    builder_.add_light(DistantLight{s.spectrum, s.scale, Vec3f(-direction(emitter, towards))}, emitter.at());
}

void LightReader::add_environment(Plugin& emitter) {
    const Transform to_world = turn(emitter);
    const auto scale = static_cast<float>(emitter.number("scale", 1, 0));
    emitter.skip("mis_compensation"); // ours is a setting of the integrator
    ImageInfiniteLight light;
    light.environment = builder_.add_light_picture(environment_rows(picture_in_file(emitter, "filename")),
                                                   emitter.text("filename", ""), emitter.at());
    light.layout = EnvironmentLayout::equirectangular;
    light.scale = scale * white_of_pictures();
    // Mitsuba's map has its north pole at +y, and its columns go from -z towards +x.
    const Matrix4 light_from_map{{{{0, 1, 0, 0}, {0, 0, 1, 0}, {-1, 0, 0, 0}, {0, 0, 0, 1}}}};
    light.world_from_light = to_world * *Transform::from_matrix(light_from_map);
    builder_.add_light(light, emitter.at());
}

void LightReader::add_projector(Plugin& emitter) {
    const Transform to_world = turn(emitter);
    Image picture(1, 1, {"R", "G", "B"});
    double picture_scale = 1;
    ProjectionLight light;
    if (const std::optional<Picture> found = this->picture(emitter, "irradiance")) {
        LightPicture given = picture_of_texture(found->texture);
        picture = std::move(given.image);
        light.picture_lookup = given.lookup;
        picture_scale = found->scale;
        light.equal_energy = found->equal_energy;
    } else {
        Vec3d color{1, 1, 1};
        if (const Property* property = emitter.find("irradiance")) {
            if (const auto* rgb = std::get_if<RgbValue>(&property->value))
                color = rgb->rgb;
            else if (const auto* number = std::get_if<double>(&property->value))
                color = {*number, *number, *number};
            else
                emitter.error("'irradiance' of a projector is " + std::string(type_name(property->value)) +
                              "; expected a colour or a 'bitmap'");
        }
        for (int c = 0; c < 3; ++c) picture.set(0, 0, c, static_cast<float>(color[c]));
    }
    const double aspect = double(picture.width()) / picture.height();
    const double half = std::tan(horizontal_fov(emitter, aspect) * pi / 360);
    light.fov = static_cast<float>(2 * std::atan(aspect > 1 ? half / aspect : half) * 180 / pi);
    // Mitsuba's projector gives the plane at distance 1 pi times its irradiance.
    light.scale = static_cast<float>(pi * picture_scale * emitter.number("scale", 1, 0)) *
                  white_of_pictures(light.equal_energy);
    light.profile = ProjectionProfile::irradiance;
    light.environment = builder_.add_light_picture(picture, emitter.describe(), emitter.at());
    // The picture's columns go towards -x and its rows towards -y.
    light.world_from_light = to_world * Transform::scale({-1, -1, 1});
    builder_.add_light(light, emitter.at());
}

void LightReader::add_sky(Plugin& emitter) {
    const Transform to_world = turn(emitter);
    SceneBuilder::SkyLights sky;
    sky.world_from_light = to_world;
    sky.settings.atmosphere.turbidity = emitter.number("turbidity", 3, least_turbidity, most_turbidity);
    sky.settings.ground_albedo = Spectrum(0.3f);
    if (const Property* albedo = emitter.find("albedo"))
        sky.settings.ground_albedo = spectrum_of(*albedo, SpectrumUse::reflectance, emitter.graph());
    Vec3d sun; // in the space of the light: x to the north, z up
    if (emitter.has("sun_direction")) {
        sun = to_world.inverse_vector(emitter.vector("sun_direction", {}));
        for (const char* name :
             {"latitude", "longitude", "timezone", "year", "month", "day", "hour", "minute", "second"})
            if (emitter.has(name))
                emitter.error("'sun_direction' together with " + in_quotes(name) +
                              "; expected one or the other");
    } else {
        sun = read_sun_position(emitter);
    }
    sun = direction(emitter, sun);
    sky.settings.elevation = std::asin(std::clamp(sun.z, -1.0, 1.0)) * 180 / pi;
    sky.settings.azimuth = std::atan2(sun.y, sun.x) * 180 / pi;
    // Absolute radiance, as a spectrum in a file is.
    sky.scale = photometric_scale(Spectrum(1.0f)) / static_cast<float>(luminous_efficacy);
    sky.sun_factor = static_cast<float>(emitter.number("sun_scale", 1, 0));
    sky.sky_factor = static_cast<float>(emitter.number("sky_scale", 1, 0));
    emitter.ignore("sun_aperture", "the sun is as wide as it is seen from the earth");
    emitter.ignore("complex_sun", "the sun's disc is even");
    emitter.warn(
        "the sky of the emitter 'sunsky' is computed by the atmosphere of our own sky light, which differs "
        "from Mitsuba's fit");
    builder_.add_sky(sky, emitter.at());
}

} // namespace montelux::mitsuba
