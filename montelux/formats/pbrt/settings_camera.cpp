#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "montelux/formats/pbrt/coverage.h"
#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/settings.h"
#include "montelux/formats/pbrt/tokenizer.h"
#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/camera/lens_system.h"

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

// Rows of four numbers in millimetres: radius of curvature, thickness, index of refraction, diameter of the
// aperture; '#' begins a comment.
std::vector<LensSurface> read_lens(ParameterReader& r, Files& files, Diagnostics& diagnostics,
                                   float stop_diameter) {
    const std::optional<std::string> name = r.string("lensfile");
    if (!name) r.error("camera 'realistic' needs a parameter 'string lensfile'");
    const Location at = r.at("lensfile");
    const std::filesystem::path path = files.find(*name, at);
    const std::vector<std::uint8_t> bytes = files.read(path, at);
    Tokenizer tokens({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                     diagnostics.add_file(path.string()), diagnostics);
    std::vector<float> numbers;
    tokens.read_numbers(numbers);
    if (const Token rest = tokens.next(); rest.kind != Token::Kind::end)
        diagnostics.error(rest.at, "expected a number, read " + describe(rest));
    if (numbers.empty() || numbers.size() % 4 != 0)
        diagnostics.error(at, "'" + path.string() + "' has " + std::to_string(numbers.size()) +
                                  " numbers; expected rows of 4 (radius of curvature, thickness, index of "
                                  "refraction, diameter of the aperture)");
    constexpr std::size_t most_surfaces = 100; // lenses have some tens; each costs 20 ms
    if (numbers.size() > 4 * most_surfaces)
        diagnostics.error(at, "'" + path.string() + "' has more than " + std::to_string(most_surfaces) +
                                  " surfaces");
    std::vector<LensSurface> surfaces;
    for (std::size_t i = 0; i < numbers.size(); i += 4) {
        float diameter = numbers[i + 3];
        if (numbers[i] == 0) {
            if (stop_diameter > diameter)
                diagnostics.warn(at,
                                 "the lens has no wider aperture than " + std::to_string(diameter) + " mm");
            else
                diameter = stop_diameter;
        }
        surfaces.push_back(
            {numbers[i] * 0.001f, numbers[i + 1] * 0.001f, numbers[i + 2], diameter * 0.0005f});
    }
    return surfaces;
}

// One of pbrt-v4's shapes by name, or a picture by its file.
std::optional<AperturePicture> read_aperture(ParameterReader& r, Files& files) {
    const std::string name = r.string("aperture", "");
    if (name.empty()) return std::nullopt;
    if (std::optional<AperturePicture> known = find_aperture(name)) return known;
    // A name without a dot or a slash is more likely a misspelt name than a file.
    if (name.find_first_of("./\\") == std::string::npos) {
        std::string expected;
        for (const std::string_view known : aperture_names()) expected += std::string(known) + ", ";
        r.error("aperture", "parameter 'aperture' is " + in_quotes(name) + "; expected one of " + expected +
                                "or the file of a picture" + did_you_mean(name, aperture_names()));
    }
    const Location at = r.at("aperture");
    const std::filesystem::path path = files.find(name, at);
    const std::vector<std::uint8_t> bytes = files.read(path, at);
    try {
        return aperture_of(read_image(bytes, path.string()));
    } catch (const Error& e) {
        r.error("aperture", e.what());
    }
}

} // namespace

void read_camera(const Plugin& plugin, Files& files, Diagnostics& diagnostics, FilmSettings& film,
                 CameraSettings& settings) {
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
        RealisticCamera camera;
        const float diameter = r.number("aperturediameter", 1);
        if (!(diameter > 0)) r.error("aperturediameter", "parameter 'aperturediameter' must be positive");
        camera.focus_distance = r.number("focusdistance", 10);
        if (!(camera.focus_distance > 0))
            r.error("focusdistance", "parameter 'focusdistance' must be positive");
        camera.film_diagonal = film.diagonal;
        camera.aperture = read_aperture(r, files);
        camera.surfaces = read_lens(r, files, diagnostics, diameter);
        try {
            static_cast<void>(LensSystem(camera));
        } catch (const Error& e) {
            r.error("lensfile", e.what());
        }
        model = std::move(camera);
    } else {
        r.error("unknown camera " + in_quotes(plugin.name) + plugin_suggestion("Camera", plugin.name));
    }
    r.finish();
}

} // namespace montelux::pbrt
