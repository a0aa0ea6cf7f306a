#include "montelux/formats/mitsuba/sensors.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "montelux/formats/mitsuba/films.h"
#include "montelux/mc/math/constants.h"
#include "montelux/scene/build/float_range.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::mitsuba {
namespace {

constexpr double far_plane = 1e4;

double radians_of(double degrees) { return degrees * pi / 180; }

// Millimetres, of a picture of 36 mm x 24 mm.
double focal_length_of(Plugin& plugin) {
    const std::string text = plugin.text("focal_length", "50mm");
    const char *begin = text.data(), *end = begin + text.size();
    if (text.ends_with("mm")) end -= 2;
    double value = 0;
    const auto [next, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || next != end || !(value > 0) || !std::isfinite(value))
        plugin.error("'focal_length' is " + in_quotes(text) + "; expected millimetres, such as 50mm");
    return value;
}

// The field of view of the shorter side, degrees.
float shorter_fov(Plugin& plugin, double aspect) {
    double half = std::tan(radians_of(horizontal_fov(plugin, aspect)) / 2);
    if (aspect > 1) half /= aspect;
    return static_cast<float>(2 * std::atan(half) * 180 / pi);
}

// The part of the picture's plane that is seen: moved by shares of the whole film's width and height.
std::optional<ScreenWindow> shifted_window(Plugin& plugin, double aspect) {
    constexpr double most = 1e4;
    const double x = plugin.number("principal_point_offset_x", 0, -most, most),
                 y = plugin.number("principal_point_offset_y", 0, -most, most);
    if (x == 0 && y == 0) return std::nullopt;
    const double width = aspect > 1 ? aspect : 1, height = aspect > 1 ? 1 : 1 / aspect;
    return ScreenWindow{static_cast<float>(width * (2 * x - 1)), static_cast<float>(width * (2 * x + 1)),
                        static_cast<float>(height * (-2 * y - 1)), static_cast<float>(height * (-2 * y + 1))};
}

CameraModel read_camera(Plugin& plugin, double aspect) {
    // Everything in front of the camera is seen.
    const double far = plugin.number("far_clip", far_plane, 0);
    plugin.skip("near_clip");
    const auto focus = [&] { return static_cast<float>(plugin.number("focus_distance", far, 1e-30, 1e30)); };
    if (plugin.type() == "orthographic") {
        plugin.skip("focus_distance"); // without a lens
        return OrthographicCamera{.scale = static_cast<float>(std::min(1.0, 1 / aspect))};
    }
    PerspectiveCamera camera;
    camera.fov = shorter_fov(plugin, aspect);
    if (plugin.type() == "perspective") {
        plugin.skip("focus_distance");
        camera.screen_window = shifted_window(plugin, aspect);
        return camera;
    }
    if (!plugin.has("aperture_radius"))
        plugin.error(plugin.describe() + " needs the property 'aperture_radius'");
    camera.lens_radius = static_cast<float>(plugin.number("aperture_radius", 0, 0, 1e30));
    camera.focal_distance = focus();
    return camera;
}

} // namespace

double horizontal_fov(Plugin& plugin, double aspect) {
    double fov = 0;
    if (plugin.has("fov")) {
        if (plugin.has("focal_length"))
            plugin.error("'fov' together with 'focal_length'; expected one or the other");
        fov = plugin.number("fov", 0);
        std::string axis = plugin.choice("fov_axis", "x", {"x", "y", "diagonal", "smaller", "larger"});
        if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
        if (axis == "larger") axis = aspect > 1 ? "x" : "y";
        const double half = std::tan(radians_of(fov) / 2);
        if (fov > 0 && fov < 180 && axis != "x")
            fov = 2 * std::atan(axis == "y" ? half * aspect : half / std::sqrt(1 + 1 / (aspect * aspect))) *
                  180 / pi;
    } else {
        plugin.skip("fov_axis");
        const double half = std::hypot(36.0, 24.0) / 2 / focal_length_of(plugin);
        fov = 2 * std::atan(half / std::sqrt(1 + 1 / (aspect * aspect))) * 180 / pi;
    }
    if (!(fov > 0 && fov < 180)) plugin.error("the field of view is not between 0 and 180 degrees");
    return fov;
}

Transform mirrored_camera() { return Transform::scale({-1, 1, 1}); }

void read_sensor(Plugin plugin, MediumLibrary& media, SceneDescription& description) {
    if (plugin.type() != "perspective" && plugin.type() != "thinlens" && plugin.type() != "orthographic")
        plugin.refuse();
    const std::optional<Plugin> film = plugin.child("film"), sampler = plugin.child("sampler"),
                                medium = plugin.child("medium");
    description.film = film ? read_film(*film) : standard_film();
    description.sampler = sampler ? read_sampler(*sampler) : standard_sampler();
    CameraSettings& camera = description.scene.camera;
    camera.model = read_camera(plugin, double(description.film.width) / description.film.height);
    camera.world_from_camera = plugin.transform("to_world") * mirrored_camera();
    if (!fits_float(camera.world_from_camera))
        plugin.error("the camera's transformation is beyond what single-precision numbers hold");
    if (medium) camera.medium = media.of(*medium);
    plugin.ignore("srf", "the colours are those of the CIE observer");
    for (const char* name : {"shutter_open", "shutter_close"}) plugin.skip(name); // nothing moves
    plugin.finish();
}

} // namespace montelux::mitsuba
