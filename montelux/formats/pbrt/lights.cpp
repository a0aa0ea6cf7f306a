#include "montelux/formats/pbrt/lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "montelux/formats/pbrt/coverage.h"
#include "montelux/image/image_read.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/float_range.h"
#include "montelux/scene/light/projection_table.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::pbrt {
namespace {

float photometric_scale(const Spectrum& s, ParameterReader& r) {
    try {
        return montelux::photometric_scale(s);
    } catch (const Error& e) {
        r.error(e.what());
    }
}

Vec3f direction(ParameterReader& r, Vec3f v) {
    float l = length(v);
    if (!std::isfinite(l)) r.error("the light's direction is not finite in world space");
    if (!(l > 0)) r.error("'from' and 'to' are the same point: the light has no direction");
    return v / l;
}

Point3f place(ParameterReader& r, const Transform& world_from_light, Vec3f from) {
    const Vec3d p = world_from_light.point(Vec3d(from));
    if (!fits_float(p)) r.error("the light lies at infinity in world space");
    return Vec3f(p);
}

} // namespace

double upper_illuminance(const Image& map, EnvironmentLayout layout) {
    Vec3d weights = RgbColorSpace::srgb().luminance_weights();
    const EnvironmentGrid grid(layout, map.width(), map.height());
    double sum = 0;
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) {
            double z = double(grid.direction({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}).z);
            if (!(z > 0)) continue;
            Vec3d rgb(Vec3f(map.value(x, y, 0), map.value(x, y, 1), map.value(x, y, 2)));
            sum += dot(weights, rgb) * z * grid.solid_angle(y);
        }
    return sum / 2;
}

LightReader::Source LightReader::source(ParameterReader& r, std::string_view name,
                                        const RgbColorSpace& color_space) {
    const Parameter* p = r.any(name, {ParameterType::rgb, ParameterType::spectrum, ParameterType::blackbody});
    const Spectrum spectrum =
        p ? spectra_.read(*p, RgbMeaning::illuminant) : Spectrum(color_space.illuminant());
    Source s{builder_.add_spectrum(spectrum)};
    s.scale = r.number("scale", 1);
    if (s.scale < 0) r.error("scale", "parameter 'scale' is negative");
    s.scale *= photometric_scale(spectrum, r);
    return s;
}

Emission LightReader::read_area(const Plugin& plugin, const RgbColorSpace& color_space) {
    ParameterReader r(plugin.parameters, "area light " + in_quotes(plugin.name), plugin.at, diagnostics_);
    if (plugin.name != "diffuse")
        r.error("unknown area light " + in_quotes(plugin.name) +
                plugin_suggestion("AreaLightSource", plugin.name) + "; expected 'diffuse'");
    const std::optional<std::string> file = r.string("filename");
    if (file && r.ignored("L")) r.error("L", "'L' together with 'filename'; expected one or the other");
    Source s = source(r, "L", file ? RgbColorSpace::srgb() : color_space);
    Emission e{s.spectrum, s.scale, r.boolean("twosided", false), r.number("power", -1)};
    e.group = r.string("group", "");
    if (file) {
        e.picture = picture(*file, r.at("filename"), MapUse::picture);
        const Image& image = builder_.scene().environments[e.picture];
        const Vec3d weights = RgbColorSpace::srgb().luminance_weights();
        double sum = 0;
        for (std::size_t i = 0; i < image.sample_count(); ++i)
            sum += double(image.value_at(i)) * weights[static_cast<int>(i % 3)];
        e.picture_mean = sum / static_cast<double>(image.pixel_count());
        if (e.power > 0 && !(e.picture_mean > 0)) r.error("power", "the picture has no light to be scaled");
    }
    r.finish();
    return e;
}

void LightReader::read(const Plugin& plugin, const Transform& at_start, const Transform& at_end,
                       const RgbColorSpace& color_space) {
    bool moves = !(at_start == at_end);
    // A light that moves is made in its own space.
    const Transform world_from_light = moves ? Transform() : at_start;
    ParameterReader r(plugin.parameters, "light " + in_quotes(plugin.name), plugin.at, diagnostics_);
    std::variant<Light, SceneBuilder::SkyLights> light;
    if (plugin.name == "point") {
        Source s = source(r, "I", color_space);
        float power = r.number("power", -1);
        if (power > 0) s.scale *= point_intensity(power);
        Vec3f from = r.point3("from").value_or(Vec3f());
        light = Light(PointLight{s.spectrum, s.scale, place(r, world_from_light, from)});
    } else if (plugin.name == "spot") {
        Source s = source(r, "I", color_space);
        float cone = r.number("coneangle", 30), delta = r.number("conedeltaangle", 5);
        if (!(cone > 0 && cone <= 180))
            r.error("coneangle", "parameter 'coneangle' is not in (0, 180] degrees");
        if (!(delta >= 0 && delta <= cone))
            r.error("conedeltaangle", "parameter 'conedeltaangle' is not between 0 and 'coneangle'");
        double end = std::cos(static_cast<double>(cone) * pi / 180);
        double start = std::cos(static_cast<double>(cone - delta) * pi / 180);
        float power = r.number("power", -1);
        if (power > 0) s.scale *= spot_intensity(power, start, end);
        Vec3f from = r.point3("from").value_or(Vec3f());
        Vec3f to = r.point3("to").value_or(Vec3f(0, 0, 1));
        Vec3f axis = direction(r, world_from_light.vector(direction(r, to - from)));
        light = Light(SpotLight{s.spectrum, s.scale, place(r, world_from_light, from), axis,
                                static_cast<float>(start), static_cast<float>(end)});
    } else if (plugin.name == "distant") {
        Source s = source(r, "L", color_space);
        float illuminance = r.number("illuminance", -1);
        if (illuminance > 0) s.scale *= illuminance;
        Vec3f from = r.point3("from").value_or(Vec3f());
        Vec3f to = r.point3("to").value_or(Vec3f(0, 0, 1));
        Vec3f to_light = direction(r, world_from_light.vector(direction(r, from - to)));
        light = Light(DistantLight{s.spectrum, s.scale, to_light});
    } else if (plugin.name == "infinite" || plugin.name == "sky") {
        if (!turns_in_floats(world_from_light))
            r.error("the light's transformation is beyond what single-precision numbers hold");
        if (plugin.name == "sky")
            light = sky(r, world_from_light);
        else
            light = infinite(r, world_from_light, color_space);
    } else if (plugin.name == "goniometric" || plugin.name == "projection") {
        if (!turns_in_floats(world_from_light))
            r.error("the light's transformation is beyond what single-precision numbers hold");
        place(r, world_from_light, Vec3f());
        light = plugin.name == "projection" ? projection(r, world_from_light)
                                            : goniometric(r, world_from_light, color_space);
    } else {
        r.error("unknown light " + in_quotes(plugin.name) + plugin_suggestion("LightSource", plugin.name));
    }
    const std::string group = r.string("group", "");
    r.finish();
    if (auto* sky = std::get_if<SceneBuilder::SkyLights>(&light)) {
        sky->group = group;
        sky->world_from_light = at_start;
        if (moves) sky->world_from_light_at_end = at_end;
        builder_.add_sky(*sky, plugin.at);
        return;
    }
    Light& single = std::get<Light>(light);
    if (auto* map = std::get_if<ImageInfiniteLight>(&single); map != nullptr && map->portal && moves) {
        diagnostics_.warn_once("moving portal", plugin.at,
                               "a map with a portal does not move: it stays where it is at the start");
        map->world_from_light = at_start;
        moves = false;
    }
    if (moves)
        builder_.add_moving_light(single, at_start, at_end, plugin.at, group);
    else
        builder_.add_light(single, plugin.at, group);
}

// Corners are in world space, whatever the transformation that turns the map.
std::optional<Portal> LightReader::portal(ParameterReader& r) {
    const std::span<const float> v = r.numbers("portal", ParameterType::point3, 3);
    if (v.empty()) return std::nullopt;
    if (v.size() != 12)
        r.error("portal", "parameter 'portal' has " + std::to_string(v.size() / 3) +
                              " points; expected the 4 corners "
                              "of a rectangle");
    std::array<Point3f, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
    try {
        return Portal(corners);
    } catch (const Error& e) {
        r.error("portal", e.what());
    }
}

Light LightReader::infinite(ParameterReader& r, const Transform& world_from_light,
                            const RgbColorSpace& color_space) {
    const std::optional<Portal> through = portal(r);
    float illuminance = r.number("illuminance", -1);
    std::optional<std::string> file = r.string("filename");
    if (!file) {
        if (through && !r.ignored("L"))
            r.error("portal", "'portal' without 'filename' or 'L'; expected one of them");
        Source s = source(r, "L", color_space);
        if (illuminance > 0) s.scale *= sky_luminance(illuminance);
        return UniformInfiniteLight{s.spectrum, s.scale, through};
    }
    if (r.ignored("L")) r.error("L", "'L' together with 'filename'; expected one or the other");
    ImageInfiniteLight light;
    constexpr EnvironmentLayout equal_area = EnvironmentLayout::equal_area,
                                equirectangular = EnvironmentLayout::equirectangular;
    const std::string_view layout =
        r.choice("layout", {"auto", name_of(equal_area), name_of(equirectangular)}, "auto");
    light.environment =
        picture(*file, r.at("filename"), layout == "auto" ? MapUse::radiance : MapUse::picture);
    const Image& map = builder_.scene().environments[light.environment];
    if (layout == "auto")
        light.layout = *layout_of_size(map.width(), map.height());
    else
        light.layout = layout == name_of(equal_area) ? equal_area : equirectangular;
    if (light.layout == equal_area && map.width() != map.height())
        r.error("layout", "an equal-area map is square; this one has " + std::to_string(map.width()) + " x " +
                              std::to_string(map.height()) + " pixels");
    light.world_from_light = world_from_light;
    light.portal = through;
    light.scale = r.number("scale", 1);
    if (light.scale < 0) r.error("scale", "parameter 'scale' is negative");
    light.scale *= photometric_scale(Spectrum(RgbColorSpace::srgb().illuminant()), r);
    if (illuminance > 0) {
        double given = upper_illuminance(map, light.layout);
        if (!(given > 0)) r.error("illuminance", "the map has no light in its upper half to be scaled");
        light.scale *= static_cast<float>(static_cast<double>(illuminance) / given);
    }
    return light;
}

namespace {

std::string needed_file(ParameterReader& r) {
    const std::optional<std::string> file = r.string("filename");
    if (!file) r.error(r.plugin() + " needs a parameter 'filename'");
    return *file;
}

// Factor by which a light of that flux (lm) reaches the parameter `power`, if that is given.
float power_factor(ParameterReader& r, double flux) {
    const float power = r.number("power", -1);
    if (!(power > 0)) return 1;
    if (!(flux > 0)) r.error("power", "the picture has no light to be scaled");
    return static_cast<float>(double(power) / flux);
}

// The mean of the colours of each pixel; the picture itself if it has none.
Image grey_map(const Image& picture) {
    const Image map = rgb_map(picture);
    if (map.empty()) return picture;
    Image grey(map.width(), map.height(), {"Y"});
    for (std::size_t i = 0; i < grey.sample_count(); ++i)
        grey.f32()[i] = (map.f32()[3 * i] + map.f32()[3 * i + 1] + map.f32()[3 * i + 2]) / 3;
    return grey;
}

} // namespace

Light LightReader::goniometric(ParameterReader& r, const Transform& world_from_light,
                               const RgbColorSpace& color_space) {
    const Source s = source(r, "I", color_space);
    GoniometricLight light;
    light.spectrum = s.spectrum;
    const std::string file = needed_file(r);
    light.environment = picture(file, r.at("filename"), MapUse::intensity);
    const Image& map = builder_.scene().environments[light.environment];
    light.layout = *layout_of_size(map.width(), map.height());
    // The map's z axis is the light's y axis.
    const Matrix4 swap_yz{{{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}}};
    light.world_from_map = world_from_light * Transform(swap_yz, swap_yz);
    const EnvironmentGrid grid(light.layout, map.width(), map.height());
    double flux = 0;
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) flux += double(map.value(x, y, 0)) * grid.solid_angle(y);
    light.scale = s.scale * power_factor(r, flux);
    return light;
}

Light LightReader::projection(ParameterReader& r, const Transform& world_from_light) {
    ProjectionLight light;
    light.fov = r.number("fov", 90);
    if (!(light.fov > 0 && light.fov < 180))
        r.error("fov", "parameter 'fov' is not between 0 and 180 degrees");
    light.scale = r.number("scale", 1);
    if (light.scale < 0) r.error("scale", "parameter 'scale' is negative");
    light.scale *= photometric_scale(Spectrum(RgbColorSpace::srgb().illuminant()), r);
    light.world_from_light = world_from_light;
    const std::string file = needed_file(r);
    light.environment = picture(file, r.at("filename"), MapUse::picture);
    light.scale *= power_factor(r, projected_flux(builder_.scene().environments[light.environment], light.fov,
                                                  RgbColorSpace::srgb().luminance_weights()));
    return light;
}

Index LightReader::picture(const std::string& file, Location at, MapUse use) {
    std::filesystem::path path = files_.find(file, at);
    const auto key = std::pair{path.string(), use};
    if (auto known = pictures_.find(key); known != pictures_.end()) return known->second;
    std::vector<std::uint8_t> bytes = files_.read(path, at);
    try {
        const Image picture = read_image(bytes, path.string());
        if (use == MapUse::picture)
            return pictures_[key] = builder_.add_light_picture(picture, path.string(), at);
        const Index index = builder_.add_environment(use == MapUse::intensity ? grey_map(picture) : picture,
                                                     path.string(), at);
        if (layout_of_size(picture.width(), picture.height()) == EnvironmentLayout::equirectangular)
            diagnostics_.warn(at, path.string() + " has " + std::to_string(picture.width()) + " x " +
                                      std::to_string(picture.height()) +
                                      " pixels and is taken for a latitude-longitude map; pbrt-v4 wants it "
                                      "converted ('imgtool makeequiarea')");
        return pictures_[key] = index;
    } catch (const LocatedError&) {
        throw;
    } catch (const Error& e) {
        diagnostics_.error(at, e.what());
    }
}

} // namespace montelux::pbrt
