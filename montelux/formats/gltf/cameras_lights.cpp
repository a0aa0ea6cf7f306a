#include "montelux/formats/gltf/cameras_lights.h"

#include <algorithm>
#include <cmath>

#include "montelux/formats/named_cameras.h"
#include "montelux/mc/math/constants.h"
#include "montelux/scene/build/float_range.h"

namespace montelux::gltf {
namespace {

// The longer side of a film whose shape the camera gives.
constexpr int longer_side = 800;

Vec3d column(const Matrix4& m, std::size_t i) { return {m.m[0][i], m.m[1][i], m.m[2][i]}; }

// Without the scale of the node, as the specification asks for: x right, y up, z forward. The file's cameras and lights
// look along -z.
Transform place_of(const Matrix4& world_from_node, const Value& node, const std::string& what) {
    const Vec3d x = column(world_from_node, 0), y = column(world_from_node, 1),
                z = column(world_from_node, 2), p = column(world_from_node, 3);
    const auto matrix = [&] {
        Matrix4 m;
        const Vec3d back = normalize(z), right = normalize(cross(y, back)), up = cross(back, right);
        const Vec3d side = dot(right, x) < 0 ? -right : right; // a mirrored node shows a mirrored picture
        for (std::size_t row = 0; row < 3; ++row) {
            const int i = static_cast<int>(row);
            m.m[row] = {side[i], up[i], -back[i], p[i]};
        }
        return m;
    }();
    const std::optional<Transform> placed = Transform::from_matrix(matrix);
    if (!placed || !fits_float(*placed)) node.error("its transformation gives the " + what + " no direction");
    return *placed;
}

void set_shape(double aspect, const Value& at, FilmSettings& film) {
    constexpr double most = 1000;
    if (!(aspect >= 1 / most && aspect <= most))
        at.error("a picture " + shown_number(aspect) + " times as wide as high; expected 0.001 to 1000");
    const auto shorter = [](double ratio) {
        return std::max(1, static_cast<int>(std::lround(longer_side * ratio)));
    };
    film.width = aspect >= 1 ? longer_side : shorter(aspect);
    film.height = aspect >= 1 ? shorter(1 / aspect) : longer_side;
    film.crop = {0, 0, film.width, film.height};
}

CameraModel perspective(const Value& source, FilmSettings& film) {
    const Value p = source.required("perspective"), yfov = p.required("yfov");
    double fov = yfov.number(0);
    if (!(fov > 0 && fov < pi)) yfov.error(shown_number(fov) + " is not between 0 and pi");
    if (const std::optional<Value> aspect = p.find("aspectRatio")) {
        set_shape(aspect->number(), *aspect, film);
        // Of the shorter side.
        if (film.width < film.height) fov = 2 * std::atan(std::tan(fov / 2) * film.width / film.height);
    }
    return PerspectiveCamera{.fov = static_cast<float>(fov * 180 / pi)};
}

CameraModel orthographic(const Value& source, FilmSettings& film) {
    const Value o = source.required("orthographic"), xmag = o.required("xmag"), ymag = o.required("ymag");
    const double x = std::abs(xmag.number()), y = std::abs(ymag.number());
    if (!(x > 0)) xmag.error("0 is no width");
    if (!(y > 0)) ymag.error("0 is no height");
    set_shape(x / y, o, film);
    return OrthographicCamera{.scale = static_cast<float>(std::min(x, y))};
}

} // namespace

void choose_camera(const std::vector<PlacedCamera>& cameras, const std::optional<std::string>& asked,
                   const Value& root, SceneDescription& description) {
    description.has_camera = !cameras.empty();
    for (const PlacedCamera& camera : cameras) description.camera_names.push_back(camera.name);
    if (!asked && cameras.empty()) return;
    std::size_t number = 0;
    if (asked) {
        const std::optional<std::size_t> found = find_camera(description.camera_names, *asked);
        if (!found) root.error(no_such_camera(description.camera_names, *asked));
        number = *found;
    }
    const PlacedCamera& chosen = cameras[number];
    const Value type = chosen.camera.required("type");
    if (type.text() == "perspective")
        description.scene.camera.model = perspective(chosen.camera, description.film);
    else if (type.text() == "orthographic")
        description.scene.camera.model = orthographic(chosen.camera, description.film);
    else
        type.error("unknown camera " + in_quotes(type.text()) + "; expected 'perspective' or 'orthographic'");
    CameraSettings& camera = description.scene.camera;
    camera.world_from_camera = place_of(chosen.place.start, chosen.node, "camera");
    if (!chosen.place.moves()) return;
    const Transform end = place_of(chosen.place.end, chosen.node, "camera");
    if (can_move(camera.world_from_camera, end, chosen.node))
        camera.motion.emplace(camera.world_from_camera, end);
}

// Candela and lux are Montelux' own units: a light of RGB 1 and intensity 1 has 1 cd, and gives film RGB 1 as 1 cd/m^2.
void add_light(const Value& light, const Placement& place, const Value& node, SceneBuilder& builder) {
    const Vec3f color = light.color("color", {1, 1, 1});
    const auto intensity = static_cast<float>(light.number("intensity", 1, 0));
    const Spectrum spectrum(RgbIlluminantSpectrum(RgbColorSpace::srgb(), color));
    const SceneSpectrum emitted = builder.add_spectrum(spectrum);
    const float scale = intensity * photometric_scale(spectrum);
    const Vec3d origin = column(place.start, 3);
    if (!fits_float(origin) || !fits_float(column(place.end, 3)))
        node.error("the light lies at infinity in world space");
    const Value type = light.required("type");
    if (light.find("range"))
        light.diagnostics().warn_once("range", light.pointer(),
                                      "'range' is ignored: light reaches everywhere");
    if (type.text() == "point") {
        // It moves, but does not turn.
        const Transform start = Transform::translate(origin),
                        end = Transform::translate(column(place.end, 3));
        const PointLight point{emitted, scale, {}};
        if (start == end)
            builder.add_light(point.moved(start), node.place());
        else
            builder.add_moving_light(point, start, end, node.place());
        return;
    }
    // `make(origin, axis)`: of the world, or of its own space.
    const auto add = [&](const auto& make) {
        if (place.moves()) {
            const Transform start = place_of(place.start, node, "light"),
                            end = place_of(place.end, node, "light");
            if (can_move(start, end, node)) {
                builder.add_moving_light(make(Vec3f{0, 0, 0}, Vec3f{0, 0, 1}), start, end, node.place());
                return;
            }
        }
        const Vec3d axis = normalize(-column(place.start, 2));
        if (!is_finite(axis)) node.error("its transformation gives the light no direction");
        builder.add_light(make(Vec3f(origin), Vec3f(axis)), node.place());
    };
    if (type.text() == "directional") {
        add([&](Vec3f, Vec3f axis) { return DistantLight{emitted, scale, -axis}; });
    } else if (type.text() == "spot") {
        const std::optional<Value> spot = light.find("spot");
        const double inner = spot ? spot->number("innerConeAngle", 0, 0) : 0,
                     outer = spot ? spot->number("outerConeAngle", pi / 4, 0, pi / 2 * (1 + 1e-6)) : pi / 4;
        if (!(inner < outer)) spot->error("its inner cone is not narrower than its outer one");
        add([&](Vec3f position, Vec3f axis) {
            return SpotLight{emitted,
                             scale,
                             position,
                             axis,
                             static_cast<float>(std::cos(inner)),
                             static_cast<float>(std::cos(outer))};
        });
    } else {
        type.error("unknown light " + in_quotes(type.text()) + "; expected 'directional', 'point' or 'spot'");
    }
}

} // namespace montelux::gltf
