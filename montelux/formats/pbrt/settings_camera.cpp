#include <array>

#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/settings.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux::pbrt {
namespace {

template <typename Camera>
Camera read_projective(ParameterReader& r) {
    Camera camera;
    camera.lens_radius = r.number("lensradius", 0);
    if (camera.lens_radius < 0) r.error("lensradius", "parameter 'lensradius' is negative");
    camera.focal_distance = r.number("focaldistance", 1e6f);
    if (!(camera.focal_distance > 0)) r.error("focaldistance", "parameter 'focaldistance' must be positive");
    camera.frame_aspect_ratio = r.number("frameaspectratio");
    if (camera.frame_aspect_ratio && !(*camera.frame_aspect_ratio > 0))
        r.error("frameaspectratio", "parameter 'frameaspectratio' must be positive");
    std::span<const float> window = r.numbers("screenwindow", ParameterType::floating);
    if (!window.empty()) {
        if (window.size() != 4)
            r.error("screenwindow", "parameter 'screenwindow' has " + std::to_string(window.size()) +
                                        " values; expected 4 (x_min x_max y_min y_max)");
        if (window[0] == window[1] || window[2] == window[3])
            r.error("screenwindow", "parameter 'screenwindow' has no area");
        camera.screen_window = ScreenWindow{window[0], window[1], window[2], window[3]};
    }
    return camera;
}

} // namespace

void read_camera(const Plugin& plugin, Diagnostics& diagnostics, FilmSettings& film,
                 CameraSettings& settings) {
    constexpr std::array<std::string_view, 4> names = {"perspective", "orthographic", "spherical",
                                                       "realistic"};
    ParameterReader r(plugin.parameters, "camera " + in_quotes(plugin.name), plugin.at, diagnostics);
    std::optional<float> open = r.number("shutteropen"), close = r.number("shutterclose");
    if (open || close) {
        float exposure = close.value_or(1.0f) - open.value_or(0.0f);
        if (!(exposure > 0))
            r.error(close ? "shutterclose" : "shutteropen", "the shutter closes before it opens");
        film.exposure_time *= exposure;
        settings.shutter_open = open.value_or(0.0f);
        settings.shutter_close = close.value_or(1.0f);
    }
    CameraModel& model = settings.model;
    if (plugin.name == "perspective") {
        auto camera = read_projective<PerspectiveCamera>(r);
        camera.fov = r.number("fov", 90);
        if (!(camera.fov > 0 && camera.fov < 180))
            r.error("fov", "parameter 'fov' is not between 0 and 180 degrees");
        model = camera;
    } else if (plugin.name == "orthographic") {
        model = read_projective<OrthographicCamera>(r);
    } else if (plugin.name == "spherical") {
        read_projective<PerspectiveCamera>(r); // known and without effect, as in pbrt
        SphericalCamera camera;
        if (r.choice("mapping", {"equalarea", "equirectangular"}, "equalarea") == "equirectangular")
            camera.mapping = SphericalCamera::Mapping::equirectangular;
        model = camera;
    } else if (plugin.name == "realistic") {
        r.error("camera 'realistic' is not supported yet; expected 'perspective', 'orthographic' or "
                "'spherical'");
    } else {
        r.error("unknown camera " + in_quotes(plugin.name) + did_you_mean(plugin.name, names));
    }
    r.finish();
}

} // namespace montelux::pbrt
